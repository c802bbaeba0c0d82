#!/usr/bin/env python3
"""Installs the build into a folder and uses it: pages, completion, pipelines, Python, licences.

    tests/install/test_install.py BUILD

Shells that are not here are skipped.
"""

from __future__ import annotations

import contextlib
import importlib
import json
import os
import pty
import re
import select
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else ROOT / "build/release"
TOOLS = ("vpl-place", "vpl-eliminate", "vpl-estimate", "vpl-render", "vpl-merge", "vpl-inspect")


def run(*command: str | Path, **more: str) -> str:
    """Output of a command, which must succeed."""
    environment = {**os.environ, **more}
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    if done.returncode:
        raise AssertionError(f"{command}: {done.stderr or done.stdout}")
    return done.stdout


class InstalledTest(unittest.TestCase):
    prefix: Path
    share: Path
    path: str

    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory(prefix="bnvpl-install.")
        cls.addClassCleanup(folder.cleanup)
        cls.prefix = Path(folder.name) / "usr"
        run("cmake", "--install", BUILD, "--prefix", cls.prefix)
        cls.share = cls.prefix / "share"
        cls.path = f"{cls.prefix / 'bin'}:{os.environ['PATH']}"

    def spec(self, tool: str) -> dict[str, list[dict[str, str]]]:
        described: dict[str, list[dict[str, str]]] = json.loads(
            run(self.prefix / "bin" / tool, "--help-json")
        )
        return described


class Installed(InstalledTest):
    def test_pages_are_there_and_clean(self) -> None:
        pages = [self.share / "man/man1" / f"{tool}.1" for tool in TOOLS]
        pages += [self.share / "man/man7/bnvpl.7", self.share / "man/man5/vpl.5"]
        for page in pages:
            self.assertTrue(page.is_file(), page)
            self.assertNotIn("@", page.read_text(), page)
            if shutil.which("man"):
                done = subprocess.run(
                    ["man", "--warnings=w", "-E", "UTF-8", "-l", "-Tutf8", "-Z", page],
                    capture_output=True,
                    text=True,
                    env={**os.environ, "LC_ALL": "C.UTF-8", "MANWIDTH": "80"},
                    check=False,
                )
                self.assertEqual((done.returncode, done.stderr), (0, ""), page)

    def test_pages_name_every_option(self) -> None:
        for tool in TOOLS:
            page = (self.share / "man/man1" / f"{tool}.1").read_text().replace("\\-", "-")
            for option in self.spec(tool)["options"]:
                self.assertIn(f"\\fB--{option['name']}\\fR", page)

    def test_pipelines_take_what_is_on_the_path(self) -> None:
        makefile = self.share / "bnvpl/pipelines/Makefile"
        with tempfile.TemporaryDirectory() as folder:
            out = f"OUT={folder}/out"
            words = "CANDIDATES=1k VPLS=100 PHOTONS=10k SPP=1".split()
            small = "RENDER_FLAGS=--size 32x24"
            run("make", "-f", makefile, out, *words, small, PATH=self.path)
            self.assertTrue((Path(folder) / "out/image.exr").is_file())
            self.assertIn(
                str(self.prefix / "bin/vpl-render"), (Path(folder) / "out/render.cmd").read_text()
            )
            ninja = self.share / "bnvpl/pipelines/generate_ninja.py"
            scene = self.share / "bnvpl/scenes/cornell/scene.toml"
            run(sys.executable, "-B", ninja, scene, "--out", folder, PATH=self.path)
            graph = (Path(folder) / "build.ninja").read_text()
            self.assertIn(str(self.prefix / "bin/vpl-place"), graph)

    def test_make_help_names_the_makefile_that_is_installed(self) -> None:
        makefile = self.share / "bnvpl/pipelines/Makefile"
        self.assertIn(f"make -f {makefile} SCENE=", run("make", "-f", makefile, "help"))

    def test_add_on_comes_without_its_tests(self) -> None:
        folders = [f.name for f in (self.share / "bnvpl/blender").iterdir()]
        self.assertEqual(folders, ["bnvpl_blender"])

    def test_python_takes_the_tools_on_the_path(self) -> None:
        (package,) = self.prefix.glob("lib/python3*/*-packages/bnvpl")
        self.assertEqual(list(package.rglob("__pycache__")), [])
        self.assertTrue((package / "py.typed").is_file())
        scene = self.share / "bnvpl/scenes/cornell/scene.toml"
        code = (
            "import bnvpl\nprint(bnvpl.__file__, bnvpl.tools.find_tool('vpl-place'))\n"
            f"bnvpl.run('vpl-place', '{scene}', output='c.vpl', count=100)\n"
            "print(bnvpl.read_vpl('c.vpl').position.shape)\n"
        )
        environment = {**os.environ, "PATH": self.path, "PYTHONPATH": str(package.parent)}
        environment.pop("BNVPL_BIN", None)
        with tempfile.TemporaryDirectory() as folder:
            command = ["/usr/bin/python3", "-B", "-c", code]
            done = subprocess.run(
                command, cwd=folder, env=environment, capture_output=True, text=True, check=False
            )
        tool = self.prefix / "bin/vpl-place"
        expected = f"{package}/__init__.py {tool}\n(100, 3)\n"
        self.assertEqual((done.stdout, done.stderr), (expected, ""))

    def test_components(self) -> None:
        def files(component: str) -> set[Path]:
            with tempfile.TemporaryDirectory() as folder:
                run("cmake", "--install", BUILD, "--prefix", folder, "--component", component)
                return {p.relative_to(folder) for p in Path(folder).rglob("*") if p.is_file()}

        parts = {name: files(name) for name in ("tools", "data", "python")}
        self.assertIn(Path("share/man/man1/vpl-place.1"), parts["tools"])
        self.assertIn(Path("share/bnvpl/scenes/cornell/scene.toml"), parts["data"])
        self.assertEqual({p.parts[0] for p in parts["python"]}, {"lib"})
        everything = {p.relative_to(self.prefix) for p in self.prefix.rglob("*") if p.is_file()}
        self.assertEqual(sum(len(part) for part in parts.values()), len(everything))
        self.assertEqual(set().union(*parts.values()), everything)

    def test_packages_of_tests_are_not_those_of_the_build(self) -> None:
        script = ROOT / "scripts/install_packages.sh"
        build = run("/bin/bash", script, "--build", "fish", PATH="/nonexistent")  # no apt there
        everything = run("/bin/bash", script, PATH="/nonexistent")
        self.assertRegex(build, r"libembree-dev .* fish\n")
        self.assertNotIn("numpy", build)
        self.assertRegex(everything, r"libembree-dev .* python3-numpy ")

    def test_licences_of_all_libraries(self) -> None:
        doc = self.share / "doc/bnvpl"
        self.assertTrue((doc / "LICENSE").is_file())
        self.assertTrue((doc / "docs/guide.md").is_file())
        table = (doc / "THIRD_PARTY.md").read_text()
        for package in re.findall(r"^\| `([^`]+)`", table, re.M):
            if Path(f"/usr/share/doc/{package}/copyright").exists():
                self.assertTrue((doc / "licences" / package).is_file(), package)
        listed = set(re.findall(r"`([^`]+)`", table))
        script = (ROOT / "scripts/install_packages.sh").read_text()
        libraries = set(re.findall(r"\b(?:lib|zlib|nlohmann)[\w.+-]*-dev\b", script))
        used_by_tests = {"libgtest-dev", "libbenchmark-dev", "libboost-iostreams-dev"}
        self.assertEqual(libraries - used_by_tests - listed, set())
        copyright_file = (ROOT / "debian/copyright").read_text()
        for package in re.findall(r"^\| `([^`]+)`", table, re.M):
            self.assertRegex(copyright_file, rf"\n {re.escape(package)}, ")


class Completion(InstalledTest):
    def bash(self, *words: str) -> set[str]:
        tool = words[0]
        script = (
            f"source '{self.share}/bash-completion/completions/{tool}'\n"
            f"compopt() {{ echo compopt; }}\n"
            f"COMP_WORDS=({' '.join(repr(w) for w in words)})\n"
            f"COMP_CWORD={len(words) - 1}\n_{tool.replace('-', '_')}\n"
            'printf "%s\\n" "${COMPREPLY[@]}"\n'
        )
        return set(run("bash", "--norc", "-c", script).split())

    def test_bash(self) -> None:
        for tool in TOOLS:
            expected = {f"--{o['name']}" for o in self.spec(tool)["options"]}
            expected |= {o["letter"] for o in self.spec(tool)["options"] if o["letter"]}
            self.assertEqual(self.bash(tool, "-"), expected)
        self.assertEqual(self.bash("vpl-place", "--met"), {"--method", "--methods"})
        self.assertEqual(self.bash("vpl-place", "--method", ""), {"camera", "light"})
        self.assertEqual(self.bash("vpl-place", "-o", ""), {"compopt"})
        self.assertEqual(self.bash("vpl-place", "-n", ""), set())
        self.assertEqual(self.bash("vpl-inspect", "com"), {"compare"})
        self.assertEqual(self.bash("vpl-inspect", "compare", "--max-relm"), {"--max-relmse"})
        self.assertEqual(self.bash("vpl-inspect", "info", "--max-relm"), set())
        self.assertIn("hdr-flip", self.bash("vpl-inspect", "compare", "a", "--map", ""))

    @unittest.skipUnless(shutil.which("fish"), "fish is not here")
    def test_fish(self) -> None:
        def fish(line: str) -> set[str]:
            tool = line.split()[0]
            file = self.share / f"fish/vendor_completions.d/{tool}.fish"
            script = f"source '{file}'; complete -C '{line}'"
            with tempfile.TemporaryDirectory() as home:
                lines = run("fish", "--no-config", "-c", script, HOME=home, PATH=self.path)
            return {text.split("\t")[0] for text in lines.splitlines()}

        for tool in TOOLS:
            expected = {f"--{o['name']}" for o in self.spec(tool)["options"]}
            self.assertEqual(fish(f"{tool} --") & expected, expected)
        self.assertEqual(fish("vpl-place --method "), {"camera", "light"})
        self.assertEqual(fish("vpl-inspect com"), {"compare"})
        self.assertIn("--max-relmse", fish("vpl-inspect compare --max"))
        self.assertNotIn("--max-relmse", fish("vpl-inspect info --max"))

    def assert_zsh_shows(self, line: str, wanted: str) -> None:
        """What zsh makes of a line and a tab, in a terminal of its own, matches a pattern."""
        child, terminal = pty.fork()
        if child == 0:
            os.environ.update(PATH=self.path, TERM="dumb", PS1="", COLUMNS="400")
            os.execvp("zsh", ["zsh", "-f", "-i"])
        text = b""

        def shown() -> str:
            codes = r"\x1b\[[0-9;?]*[A-Za-z]|\r|\x07|.\x08"
            return re.sub(codes, "", text.decode(errors="replace"))

        def read_until(pattern: str, seconds: float) -> None:
            nonlocal text
            limit = time.monotonic() + seconds
            while time.monotonic() < limit and not re.search(pattern, shown()):
                if select.select([terminal], [], [], 0.1)[0]:
                    with contextlib.suppress(OSError):
                        text += os.read(terminal, 65536)

        setup = (
            f"PROMPT= RPROMPT=; unsetopt zle_bracketed_paste prompt_sp; LISTMAX=9999\n"
            f"fpath=('{self.share}/zsh/site-functions' $fpath)\n"
            "autoload -Uz compinit; compinit -u -D; print rea''dy\n"
        )
        os.write(terminal, setup.encode())
        read_until("ready", 60)
        text = b""
        os.write(terminal, line.encode() + b"\t")
        read_until(wanted, 10)
        os.close(terminal)
        os.waitpid(child, 0)
        self.assertRegex(shown(), wanted)

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not here")
    def test_zsh(self) -> None:
        for tool in TOOLS:
            file = self.share / f"zsh/site-functions/_{tool}"
            run("zsh", "-f", "-n", file)
        self.assert_zsh_shows("vpl-place --meth", "vpl-place --method")
        self.assert_zsh_shows("vpl-place --method ", r"camera\s+light")
        self.assert_zsh_shows("vpl-inspect comp", "vpl-inspect compare")
        self.assert_zsh_shows("vpl-inspect compare --max-relm", "--max-relmse")


class BuildId(unittest.TestCase):
    def header(self, flags: str) -> str:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "id.h"
            words = [f"-DSOURCE={ROOT}", f"-DHEADER={path}", f"-DFLAGS={flags}", "-DEMBREE=4.3.3"]
            run("cmake", *words, "-P", ROOT / "cmake/build_id.cmake")
            return path.read_text()

    def test_only_flags_that_change_arithmetic_count(self) -> None:
        plain = self.header("")
        self.assertIn('BNVPL_EMBREE "4.3.3"', plain)
        hardened = "-g -O2 -ffile-prefix-map=/home/math/-march=. -fstack-protector-strong -Wformat"
        self.assertEqual(self.header(hardened), plain)
        for flag in ("-march=native", "-ffast-math", "-ffp-contract=fast", "-Ofast"):
            self.assertNotEqual(self.header(f"{hardened} {flag}"), plain, flag)


class Workflow(unittest.TestCase):
    def test_runs_the_tests_where_the_docs_say_that_it_builds(self) -> None:
        text = (ROOT / ".github/workflows/ci.yml").read_text()
        jobs = importlib.import_module("yaml").safe_load(text)["jobs"]
        images = jobs["test"]["strategy"]["matrix"]["image"]
        self.assertEqual(images, ["debian:12", "debian:13", "ubuntu:24.04"])
        self.assertIn("Debian 12 and 13 and Ubuntu 24.04", (ROOT / "docs/install.md").read_text())
        self.assertEqual(jobs["test"]["steps"][-1]["run"], ".ci/run")
        for job in jobs.values():
            for step in job["steps"]:
                self.assertTrue("run" in step or "uses" in step, step)


class Version(unittest.TestCase):
    def test_one_version(self) -> None:
        project = re.search(r"project\(bnvpl VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())
        assert project
        version = re.escape(project[1])
        for file, pattern in (
            ("CITATION.cff", rf"^version: {version}$"),
            ("CHANGELOG.md", rf"^## \[{version}\] - (unreleased|20\d\d-\d\d-\d\d)$"),
            ("python/bnvpl/__init__.py", rf'^__version__ = "{version}"$'),
            ("debian/changelog", rf"\Abnvpl \({version}\) "),
        ):
            self.assertRegex((ROOT / file).read_text(), re.compile(pattern, re.M), file)
        headings = re.findall(r"^## \[([^]]+)\]", (ROOT / "CHANGELOG.md").read_text(), re.M)
        self.assertEqual(headings[0], project[1])


if __name__ == "__main__":
    unittest.main()
