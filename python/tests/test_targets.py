#!/usr/bin/python3
"""Tests that write_vpl() replaces what the tools would replace, and names the file it refuses.

test_targets.py BIN       # folder of the executables
"""

from __future__ import annotations

import os
import resource
import unittest
from pathlib import Path

from support import GOLDEN, SCENE, TestFolder, main

# isort: split
import bnvpl


class Targets(TestFolder):
    def expect_refused(self, file: Path, problem: str, kind: type[OSError] = OSError) -> None:
        before = sorted(self.folder.rglob("*"))
        with self.assertRaises(kind) as caught:
            bnvpl.write_vpl(file, bnvpl.read_vpl(GOLDEN / "lit.vpl"))
        message = str(caught.exception)
        self.assertTrue(message.startswith(f"{file}: {problem}"), message)
        self.assertNotIn("\n", message)
        self.assertEqual(sorted(self.folder.rglob("*")), before)

    def test_a_pipe_is_kept(self) -> None:
        pipe, link = self.folder / "pipe", self.folder / "link.vpl"
        os.mkfifo(pipe)
        link.symlink_to("pipe")
        for file in (pipe, link):
            self.expect_refused(file, "is a device or pipe, which cannot be replaced; name a file")
            self.assertTrue(pipe.is_fifo())

    def test_an_open_stream_is_kept(self) -> None:
        with (self.folder / "stream.vpl").open("wb") as stream:
            link = self.folder / "link.vpl"
            link.symlink_to(f"/proc/self/fd/{stream.fileno()}")
            self.expect_refused(link, "is an open stream")

    def test_folders_and_links_that_lead_nowhere(self) -> None:
        (self.folder / "loop.vpl").symlink_to("loop.vpl")
        (self.folder / "notes").write_text("somebody's")
        self.expect_refused(self.folder / "loop.vpl", "is a loop of links; name a file")
        self.expect_refused(self.folder, "is a folder; name a file", IsADirectoryError)
        self.expect_refused(
            self.folder / "missing/x.vpl", "cannot write: No such file or directory; choose a",
            FileNotFoundError,
        )  # fmt: skip
        self.expect_refused(
            self.folder / "notes/x.vpl", "cannot write: Not a directory; choose a folder",
            NotADirectoryError,
        )  # fmt: skip

    def test_vpls_of_another_stage_are_kept(self) -> None:
        file = self.folder / "x.vpl"
        for stage in ("candidates", "eliminated"):
            file.unlink(missing_ok=True)
            bnvpl.write_vpl(file, bnvpl.read_vpl(GOLDEN / f"{stage}.vpl"))
            old = file.read_bytes()
            self.expect_refused(file, f"holds VPLs of stage {stage}, not lit; name another file")
            self.assertEqual(file.read_bytes(), old)
        with self.assertRaisesRegex(bnvpl.ToolError, "name another file, or remove this one"):
            bnvpl.run("vpl-place", SCENE, count=1, output=file)  # the tools refuse them, too
        file.write_bytes(b"")  # an empty file is nobody's work
        bnvpl.write_vpl(file, bnvpl.read_vpl(GOLDEN / "lit.vpl"))
        self.assertEqual(bnvpl.read_vpl(file).stage, "lit")

    def test_what_the_system_refuses_names_the_file(self) -> None:
        """A limit on the size of files stands for a full disk."""
        file = self.folder / "x.vpl"
        old = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (1000, old[1]))
        try:
            self.expect_refused(file, "write failed: File too large; the old file, if any, is")
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, old)

    def test_a_file_of_another_kind_is_kept(self) -> None:
        file = self.folder / "scene.obj"
        file.write_text("v 0 0 0\n")
        self.expect_refused(file, "exists and is no .vpl file; name another file", FileExistsError)
        self.assertEqual(file.read_text(), "v 0 0 0\n")

    def test_links_are_followed_and_modes_kept(self) -> None:
        vpls = bnvpl.read_vpl(GOLDEN / "lit.vpl")
        real, link = self.folder / "real.vpl", self.folder / "link.vpl"
        link.symlink_to("real.vpl")
        for mode in (0o600, 0o640):
            bnvpl.write_vpl(link, vpls)
            self.assertTrue(link.is_symlink())
            real.chmod(mode)
            bnvpl.write_vpl(link, vpls)
            self.assertEqual(real.stat().st_mode & 0o777, mode)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["link.vpl", "real.vpl"])

    @unittest.skipIf(os.geteuid() == 0, "root may write read-only files")
    def test_a_read_only_file_is_kept(self) -> None:
        file = self.folder / "x.vpl"
        file.write_bytes((GOLDEN / "lit.vpl").read_bytes())
        file.chmod(0o444)
        with self.assertRaises(PermissionError):
            bnvpl.write_vpl(file, bnvpl.read_vpl(GOLDEN / "lit.vpl"))


if __name__ == "__main__":
    main()
