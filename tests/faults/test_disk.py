"""Tests targets that cannot be written, and disks that are full or fail.

They yield exit code 4 and one line, and every file stays as it was.
"""

import errno
import os
import resource
import shutil
import subprocess
import time
import unittest
from dataclasses import replace
from pathlib import Path
from typing import Any

from workbench import (
    BIN,
    COMMANDS,
    FULL,
    OK,
    OUTPUT,
    SCENE,
    SOURCE,
    Command,
    Workbench,
    needs_shim,
    require,
)


def limit_file_size() -> None:
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, resource.RLIM_INFINITY))


class Targets(Workbench):
    def refused(self, command: Command, *parts: str, **settings: Any) -> None:
        result = self.run_command(command, **settings)
        self.assertEqual(result.code, OUTPUT, f"{command.name}: {result}")
        self.assert_one_line(command, result, *parts)

    def test_missing_folder(self) -> None:
        whole = self.folder
        for command in COMMANDS:
            self.folder = whole / "absent"
            self.refused(command, "absent/", "No such file or directory")
        self.folder = whole
        self.assertEqual(list(whole.iterdir()), [])

    def test_folder_that_vanishes_during_the_work(self) -> None:
        for command in COMMANDS:
            self.right(command)
            whole, self.folder = self.folder, self.folder / "soon gone"
            self.folder.mkdir()
            process = self.start(command)
            time.sleep(self.random.uniform(0, 0.5 * self.seconds[command.name]))
            shutil.rmtree(self.folder, ignore_errors=True)  # the process may write there meanwhile
            result = self.finish(process, 0)
            self.assertIn(result.code, (OK, OUTPUT), f"{command.name}: {result}")
            if result.code == OUTPUT:
                self.assert_one_line(command, result, "No such file or directory")
            shutil.rmtree(self.folder, ignore_errors=True)  # where the process was faster
            self.folder = whole

    def test_one_output_without_a_folder_leaves_all_as_they_were(self) -> None:
        for command in COMMANDS:
            for name in command.outputs:
                self.put_old(command)
                elsewhere = command.arguments.replace("{out}/" + name, "{out}/absent/" + name)
                self.refused(replace(command, arguments=elsewhere), "absent/" + name)
                self.assert_all(command, "old", f"no folder for {name}")

    def test_read_only_file_system(self) -> None:
        """Uses a read-only bind mount in a mount namespace, where root cannot write either."""
        require("unshare")
        flags = ["--mount"] if os.geteuid() == 0 else ["--map-root-user", "--mount"]
        script = 'mount --bind "$0" "$0" && mount -o remount,bind,ro "$0" && exec "$@"'
        probe = subprocess.run(
            ["unshare", *flags, "sh", "-c", script, self.folder, "true"], capture_output=True
        )
        if probe.returncode != 0:
            self.skipTest(f"no read-only mount: {probe.stderr.decode().strip()}")
        for command in COMMANDS:
            for old in (False, True):
                if old:
                    self.put_old(command)
                result = subprocess.run(
                    [
                        "unshare",
                        *flags,
                        "sh",
                        "-c",
                        script,
                        self.folder,
                        *command.line(self.folder),
                    ],
                    cwd=SOURCE,
                    capture_output=True,
                    text=True,
                )
                self.assertEqual(result.returncode, OUTPUT, f"{command.name}: {result}")
                self.assertRegex(
                    result.stderr, rf"\A{command.tool}: [^\n]*Read-only file system[^\n]*\n\Z"
                )
                self.assert_all(command, "old" if old else "absent", "read-only file system")

    def test_read_only_folder_and_file(self) -> None:
        """Runs as a user without rights; root takes the id of such a user."""
        user: dict[str, Any] = {}
        if os.geteuid() == 0:
            user = {"user": 65534, "group": 65534, "extra_groups": []}
        if user:
            for folder in (self.folder, self.made):
                folder.chmod(0o755)
            try:
                probe = subprocess.run(
                    [BIN / "vpl-place", "--version"], capture_output=True, **user
                )
            except PermissionError:
                self.skipTest(f"cannot run {BIN} as another user")
            if probe.returncode != 0:
                self.skipTest(f"cannot run {BIN} as another user: {probe.stderr}")
        for command in COMMANDS:
            self.put_old(command)
            self.folder.chmod(0o555)
            self.refused(command, "Permission denied", **user)
            self.folder.chmod(0o777)
            for name in command.outputs:
                (self.folder / name).chmod(0o444)
            self.refused(command, "cannot replace: Permission denied; make it writable", **user)
            self.assert_all(command, "old", "read-only")
            self.assertEqual(self.left_over(), [])
            for name in command.outputs:
                (self.folder / name).unlink()


class FoldersThatKeepFiles(Workbench):
    """Refuses, before the work, folders where a file may be written but not renamed."""

    def long_refused(self, words: list[Any], *parts: str, **settings: Any) -> None:
        """Expects that a render of hours ends at once, with these parts of a message."""
        line: list[Any] = [BIN / "vpl-render", SCENE, "--integrator", "path"]
        line += ["--spp", "100M", *words]
        before = sorted(self.folder.iterdir())
        result = subprocess.run(
            line, cwd=SOURCE, capture_output=True, text=True, timeout=30, **settings
        )
        self.assertEqual(result.returncode, OUTPUT, result)
        self.assertRegex(result.stderr, r"\Avpl-render: [^\n]+\n\Z")
        for part in parts:
            self.assertIn(part, result.stderr)
        self.assertEqual(sorted(self.folder.iterdir()), before)

    def test_sticky_folder_with_a_file_of_another(self) -> None:
        """Root borrows the number of a user, and owns the file."""
        if os.geteuid() != 0:
            self.skipTest("only root can make a file of another user")
        user: dict[str, Any] = {"user": 65534, "group": 65534, "extra_groups": []}
        self.folder.chmod(0o1777)
        try:
            version: list[Any] = [BIN / "vpl-render", "--version"]
            subprocess.run(version, capture_output=True, check=True, **user)
        except (PermissionError, subprocess.CalledProcessError):
            self.skipTest(f"cannot run {BIN} as another user")
        for name in ("i.exr", "i.png", "i.json", "i.d"):
            (self.folder / name).write_bytes(self.old(name))
            (self.folder / name).chmod(0o666)
        image: list[Any] = ["-o", self.folder / "i.exr"]
        other: list[Any] = ["-o", self.folder / "new.exr"]
        theirs = "i.exr: cannot replace: it is another user's"
        self.long_refused(image, theirs, "sticky", "name another", **user)
        for option, name in (("--png", "i.png"), ("--stats", "i.json"), ("--depfile", "i.d")):
            asked: list[Any] = [*other, option, self.folder / name]
            self.long_refused(asked, f"{name}: cannot replace", **user)
        words: list[Any] = [BIN / "vpl-render", SCENE, "--integrator", "path"]
        words += ["--spp", "1", "--quiet"]
        for target in (other, other):  # its own file there can be replaced
            self.assertEqual(subprocess.run([*words, *target], cwd=SOURCE, **user).returncode, OK)
        self.assertEqual(subprocess.run([*words, *image], cwd=SOURCE).returncode, OK)  # root may

    def with_attribute(self, path: Path, letter: str) -> None:
        require("chattr")
        if subprocess.run(["chattr", f"+{letter}", path], capture_output=True).returncode != 0:
            self.skipTest("no rights or no file system for chattr")
        self.addCleanup(lambda: subprocess.run(["chattr", f"-{letter}", path], check=False))

    def test_folder_that_only_lets_files_be_added(self) -> None:
        (self.folder / "i.exr").write_bytes(self.old("i.exr"))
        self.with_attribute(self.folder, "a")
        for name in ("i.exr", "new.exr"):
            told = (f"{name}: cannot write", "chattr +a", "choose another folder")
            self.long_refused(["-o", self.folder / name], *told)

    def test_protected_files(self) -> None:
        for letter in "ai":
            file = self.folder / f"{letter}.exr"
            file.write_bytes(self.old(file.name))
            self.with_attribute(file, letter)
            self.long_refused(["-o", file], f"{file.name}: cannot replace")

    def test_a_mount_as_the_target(self) -> None:
        require("unshare")
        flags = ["--mount"] if os.geteuid() == 0 else ["--map-root-user", "--mount"]
        file = self.folder / "i.exr"
        file.write_bytes(self.old("i.exr"))
        script = 'mount --bind "$0" "$0" && exec "$@"'
        mounted: list[Any] = ["unshare", *flags, "sh", "-c", script, file]
        if subprocess.run([*mounted, "true"], capture_output=True).returncode != 0:
            self.skipTest("no bind mount")
        words: list[Any] = [BIN / "vpl-render", SCENE, "--integrator", "path"]
        words += ["--spp", "100M", "-o", file]
        result = subprocess.run(
            [*mounted, *words], cwd=SOURCE, capture_output=True, text=True, timeout=30
        )
        self.assertEqual(result.returncode, OUTPUT, result)
        self.assertIn("i.exr: cannot replace: it is a mount of its own", result.stderr)
        self.assertEqual(list(self.folder.iterdir()), [file])


class FullDisks(Workbench):
    def test_small_tmpfs(self) -> None:
        """Uses a tmpfs that is too small for the product, in a mount namespace."""
        require("unshare")
        flags = ["--mount"] if os.geteuid() == 0 else ["--map-root-user", "--mount"]
        # The script lists the folder itself, as its content vanishes with the namespace.
        script = (
            'mount -t tmpfs -o size=8k none "$0" && cd "$0" && printf "" > "$1" && shift && '
            '"$@"; code=$?; '
            'cd "$0" && echo "left: $(ls -A) $(cat *)"; exit $code'
        )
        probe = subprocess.run(
            ["unshare", *flags, "sh", "-c", script, self.folder, "x", "true"], capture_output=True
        )
        if probe.returncode != 0:
            self.skipTest(f"no tmpfs: {probe.stderr.decode().strip()}")
        for command in COMMANDS:
            product = command.outputs[0]
            line = command.line(self.folder)
            result = subprocess.run(
                ["unshare", *flags, "sh", "-c", script, self.folder, product, *line, "--quiet"],
                capture_output=True,
                text=True,
            )
            self.assertEqual(result.returncode, OUTPUT, f"{command.name}: {result}")
            self.assertRegex(
                result.stderr, rf"\A{command.tool}: [^\n]*No space left on device[^\n]*\n\Z"
            )
            self.assertEqual(result.stdout, f"left: {product} \n")

    def test_limit_on_file_size(self) -> None:
        """Without a handler of SIGXFSZ the process would end without a message."""
        for command in COMMANDS:
            self.right(command)
            self.put_old(command)
            result = self.run_command(command, preexec_fn=limit_file_size)
            self.assertEqual(result.code, OUTPUT, f"{command.name}: {result}")
            self.assert_one_line(
                command, result, "write failed: File too large; the old file, if any, is unchanged"
            )
            self.assert_all(command, "old", "limit on file size")
            self.assertEqual(self.left_over(), [])

    @needs_shim
    def test_every_call_that_can_fail(self) -> None:
        """Each write, fsync and rename fails in turn, and with it all later calls of its kind.

        The quick run tries the first four writes and every fourth of the others.
        """
        for command in COMMANDS:
            self.right(command)
            for call, error in (
                ("write", errno.ENOSPC),
                ("fsync", errno.EIO),
                ("rename", errno.EIO),
            ):
                tried = self.fail_each(command, call, error)
                self.assertGreaterEqual(tried, len(command.outputs), f"{command.name}: {call}")
                self.say(f"{command.name}: {tried} calls of {call} failed in turn")

    def fail_each(self, command: Command, call: str, error: int) -> int:
        tried = 0
        for at in range(1, 1000):
            if not FULL and at > 4 and at % 4 != 0:
                continue
            self.put_old(command)
            result = self.run_command(command, {"call": call, "at": at, "errno": error})
            states = self.states(command)
            what = f"{command.name}: {call} {at}: {result} {states}"
            self.assertEqual(self.left_over(), [], what)
            if result.code == OK:
                self.assertEqual(set(states.values()), {"new"}, what)
                return tried
            tried += 1
            self.assertEqual(result.code, OUTPUT, what)
            self.assert_one_line(command, result, os.strerror(error))
            self.assertLessEqual(set(states.values()), {"old", "new"}, what)
            if (
                call == "write"
                or (call, at) == ("rename", 1)
                or (call == "fsync" and at <= len(command.outputs))
            ):
                self.assertEqual(set(states.values()), {"old"}, what)
            if call == "rename":
                self.assertEqual(states[command.outputs[0]], "old", what)
                self.assertEqual(at > 1, "companions that came before it are new" in result.err)
            if "was replaced" not in result.err:
                self.assertEqual(states[command.outputs[0]], "old", what)
        self.fail(f"{command.name}: more than 999 calls of {call}")


if __name__ == "__main__":
    unittest.main()
