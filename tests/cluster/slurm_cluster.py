"""Starts a real Slurm of four nodes on one host, as ordinary processes in a folder of their own.

It needs Debian's slurmctld, slurmd, slurm-client and munge, but no root, no service, and no
configuration outside the folder.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import pathlib
import pwd
import shutil
import signal
import socket
import subprocess
import time
from collections.abc import Callable, Iterable

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol", "sinfo")
NODES = ("n1", "n2", "n3", "n4")

# All waits are as short as Slurm accepts them, as nobody else uses this cluster.
CONF = """\
ClusterName=bnvpl
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool/%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/%n.pid
SlurmctldLogFile={folder}/log/slurmctld.log
SlurmdLogFile={folder}/log/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
SchedulerType=sched/backfill
SchedulerParameters=bf_interval=2,sched_interval=2
SlurmdParameters=config_overrides
BatchStartTimeout=1
MessageTimeout=5
SlurmdTimeout=8
KillWait=2
MinJobAge=1200
ReturnToService=2
MailProg=/bin/true
"""


def missing_programs() -> list[str]:
    return [name for name in PROGRAMS if not find(name)]


def find(name: str) -> str | None:
    return shutil.which(name, path=f"{os.environ.get('PATH', '')}:/usr/sbin:/usr/local/sbin")


def free_ports(count: int) -> list[int]:
    """Ports that nobody uses now."""
    sockets = [socket.socket() for _ in range(count)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


def processes() -> dict[int, tuple[int, list[str]]]:
    """Parent and arguments of each process of this user, by pid."""
    found = {}
    for folder in pathlib.Path("/proc").iterdir():
        if not folder.name.isdigit():
            continue
        try:
            if folder.stat().st_uid != os.getuid():
                continue
            parent = int(folder.joinpath("stat").read_text().rpartition(")")[2].split()[1])
            words = folder.joinpath("cmdline").read_bytes().split(b"\0")[:-1]
        except OSError:  # the process has ended
            continue
        found[int(folder.name)] = (parent, [word.decode(errors="replace") for word in words])
    return found


def die_with_parent() -> None:
    """Makes a daemon end with the test, even if that is killed."""
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG


def kill(pids: Iterable[int], how: int = signal.SIGKILL) -> None:
    for pid in pids:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, how)


class Cluster:
    """A context in which the cluster runs. Its folder needs a short path, as it holds sockets."""

    def __init__(self, folder: pathlib.Path) -> None:
        self.folder = pathlib.Path(folder)
        self.daemons: dict[str, subprocess.Popen[bytes]] = {}
        self.environment = os.environ | {"SLURM_CONF": f"{self.folder}/slurm.conf"}

    def __enter__(self) -> Cluster:
        try:
            self.configure()
            self.start(
                "munged",
                "--foreground",
                "--force",
                f"--socket={self.folder}/munge.socket",
                f"--key-file={self.folder}/munge.key",
                f"--pid-file={self.folder}/munge.pid",
                f"--log-file={self.folder}/log/munge.log",
                f"--seed-file={self.folder}/munge.seed",
            )
            self.wait_for("munged", lambda: (self.folder / "munge.socket").exists())
            self.start("slurmctld", "-D", "-c")
            for node in NODES:
                self.start_node(node)
            self.wait_for(
                "the nodes",
                lambda: (
                    self.ask("sinfo", "-h", "-t", "idle", "-o", "%D").strip() == str(len(NODES))
                ),
            )
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def configure(self) -> None:
        for name in ("state", "spool", "log"):
            (self.folder / name).mkdir(parents=True)
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        port, *ports = free_ports(1 + len(NODES))
        rows = CONF.format(
            folder=self.folder,
            host=socket.gethostname().split(".")[0],
            port=port,
            user=pwd.getpwuid(os.getuid()).pw_name,
        )
        for node, node_port in zip(NODES, ports, strict=True):
            rows += (
                f"NodeName={node} NodeAddr=127.0.0.1 Port={node_port} CPUs=1 RealMemory=2000 "
                "State=UNKNOWN\n"
            )
        rows += f"PartitionName=all Nodes={','.join(NODES)} Default=YES MaxTime=INFINITE State=UP\n"
        (self.folder / "slurm.conf").write_text(rows)
        (self.folder / "cgroup.conf").write_text("")

    def start(self, name: str, *arguments: str, label: str | None = None) -> None:
        with open(self.folder / "log" / f"{label or name}.out", "ab") as log:
            self.daemons[label or name] = subprocess.Popen(
                [find(name) or name, *arguments],
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                env=self.environment,
                start_new_session=True,
                preexec_fn=die_with_parent,
            )

    def start_node(self, node: str) -> None:
        self.start("slurmd", "-D", "-N", node, label=node)

    def wait_for(self, what: str, ready: Callable[[], bool], limit_s: float = 60) -> None:
        end = time.monotonic() + limit_s
        while not ready():
            ended = [name for name, daemon in self.daemons.items() if daemon.poll() is not None]
            if ended or time.monotonic() > end:
                raise RuntimeError(
                    f"{what}: {'ended' if ended else 'not ready'}:\n"
                    + self.log_of(*(ended or ["slurmctld"]))
                )
            time.sleep(0.3)

    def log_of(self, *names: str) -> str:
        return "".join(
            file.read_text(errors="replace")[-3000:]
            for name in names
            for file in sorted((self.folder / "log").glob(f"{name}.*"))
        )

    def ask(self, *command: str, timeout: float = 60) -> str:
        """Output of a command of Slurm; '' where it fails, as it may while slurmctld is busy."""
        try:
            return subprocess.run(
                command,
                env=self.environment,
                text=True,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                timeout=timeout,
            ).stdout
        except subprocess.TimeoutExpired:
            return ""

    def steps(self) -> dict[int, str]:
        """Node of each process that jobs run, by pid: each slurmstepd and all below it."""
        all_processes = processes()
        children: dict[int, list[int]] = {}
        for pid, (parent, _) in all_processes.items():
            children.setdefault(parent, []).append(pid)
        found = {}
        for pid, (_, words) in all_processes.items():
            if words and words[0].startswith("slurmstepd") and (node := self.node_of(pid)):
                below = [pid]
                for each in below:  # the list grows meanwhile
                    below += children.get(each, [])
                    found[each] = node
        return found

    def node_of(self, pid: int) -> str | None:
        """The node whose folder holds the socket and log of the process."""
        try:
            for file in pathlib.Path(f"/proc/{pid}/fd").iterdir():
                target = os.readlink(file)
                for node in NODES:
                    if target == f"{self.folder}/log/{node}.log" or target.startswith(
                        f"{self.folder}/spool/{node}/"
                    ):
                        return node
        except OSError:
            pass
        return None

    def fail_node(self, node: str) -> int:
        """Kills a node's daemon, its steps and all that they run, as a power failure does."""
        daemon = self.daemons.pop(node)
        daemon.kill()
        struck = [pid for pid, of in self.steps().items() if of == node]
        kill(struck)
        daemon.wait()
        return len(struck)

    def stop(self) -> None:
        """Ends everything, whatever state it is in."""
        if "slurmctld" in self.daemons:
            self.ask("scancel", "--me", timeout=10)
        kill(self.steps())
        for daemon in reversed(self.daemons.values()):
            daemon.terminate()
        end = time.monotonic() + 10
        for daemon in self.daemons.values():
            try:
                daemon.wait(max(0.1, end - time.monotonic()))
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        kill(self.steps())
        self.daemons = {}
