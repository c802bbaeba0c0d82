#!/usr/bin/python3
"""Tests that Python reads and writes .vpl files as the tools do.

test_files.py BIN       # folder of the executables
"""

from __future__ import annotations

import random
import re
import struct
import subprocess
from pathlib import Path

import numpy as np

from support import BIN, GOLDEN, ROOT, TestFolder, main

# isort: split
import bnvpl
from bnvpl import columns, layout


def with_checksum(data: bytes) -> bytes:
    """The file with the checksum that its content has, so that the checks behind it are reached."""
    right = layout.checksum(data[: layout.Header.SIZE], [data[layout.Header.SIZE :]])
    at = layout.CHECKSUM_AT
    return data[:at] + right.to_bytes(8, "little") + data[at + 8 :]


class RoundTrip(TestFolder):
    def test_golden_files_are_written_back_byte_for_byte(self) -> None:
        files = sorted(GOLDEN.glob("*.vpl"))
        self.assertGreaterEqual(len(files), 4)
        for file in files:
            for verify in (True, False):
                copy = self.folder / file.name
                bnvpl.write_vpl(copy, bnvpl.read_vpl(file, verify))
                self.assertEqual(copy.read_bytes(), file.read_bytes(), file)

    def test_values_of_the_golden_files(self) -> None:
        lit = bnvpl.read_vpl(GOLDEN / "lit.vpl")
        self.assertEqual((lit.stage, lit.scene_hash), ("lit", "0123456789abcdef"))
        self.assertEqual((lit.r_max, lit.area, lit.reach), (0.75, 12.0, 2.5))
        self.assertEqual(lit.indirect_share, 0.625)
        self.assertEqual(lit.flux.tolist(), [[1, 2, 4], [0, 0, 0]])
        self.assertEqual(lit.position.tolist(), [[1, 2, -3], [0.5, 0.25, -0.125]])
        self.assertEqual(lit.units["flux"], "W")
        self.assertEqual(lit.provenance[0]["tool"], "vpl-place")
        self.assertEqual(lit.emit_position.shape, (2, 1, 3))
        self.assertEqual(lit.photons.dtype, np.uint64)
        extra = bnvpl.read_vpl(GOLDEN / "methods.vpl")
        self.assertEqual(extra["rich.lobes"].shape, (2, 4))
        self.assertEqual(extra["light-slice.cluster"].shape, (2,))
        self.assertEqual(extra["rich.seeds"].tolist(), [[0, 1], [1 << 33, (1 << 33) + 1]])

    def test_columns_are_those_of_the_specification(self) -> None:
        rows = re.findall(
            r"^\| `(\w+)` \| (f32|u32|u64)(?: × (\d))? \| ([^|]+) \| (\w+) \|",
            (ROOT / "formats/README.md").read_text(),
            re.M,
        )
        types = {"f32": "<f4", "u32": "<u4", "u64": "<u8"}
        self.assertEqual(
            [
                (name, types[kind], int(width or 1), unit, since)
                for name, kind, width, unit, since in rows
            ],
            [(c.name, c.dtype, c.width, c.unit, c.since) for c in columns.COLUMNS.values()],
        )

    def test_changed_and_new_columns_come_back(self) -> None:
        lit = bnvpl.read_vpl(GOLDEN / "lit.vpl")
        lit.flux *= 2
        lit.emit_position = np.repeat(lit.position[:, None], 3, axis=1)
        lit.emit_normal = np.repeat(lit.normal[:, None], 3, axis=1)
        lit["mine.heat"] = np.array([[1.5, 2.5], [3.5, 4.5]])
        lit.provenance.append({"tool": "mine", "options": {"factor": 2, "note": "a\ufffdb"}})
        bnvpl.write_vpl(self.folder / "x.vpl", lit)
        self.check("x.vpl")
        back = bnvpl.read_vpl(self.folder / "x.vpl")
        self.assertEqual(back.flux.tolist(), lit.flux.tolist())
        self.assertEqual(back.emit_position.shape, (2, 3, 3))
        self.assertEqual(back["mine.heat"].tolist(), [[1.5, 2.5], [3.5, 4.5]])
        self.assertEqual(back.provenance, lit.provenance)

    def test_rows_are_taken_with_all_columns(self) -> None:
        vpls = bnvpl.read_vpl(GOLDEN / "methods.vpl")
        bnvpl.write_vpl(self.folder / "x.vpl", vpls.take([1]))
        self.check("x.vpl")
        back = bnvpl.read_vpl(self.folder / "x.vpl")
        self.assertEqual(len(back), 1)
        for name, values in vpls.columns.items():
            self.assertEqual(back[name].tolist(), values[1:].tolist(), name)
        bnvpl.write_vpl(self.folder / "x.vpl", vpls.take(vpls.radius > 100))
        self.check("x.vpl")
        self.assertEqual(len(bnvpl.read_vpl(self.folder / "x.vpl")), 0)

    def check(self, name: str) -> None:
        bnvpl.run("vpl-inspect", "check", self.folder / name)


class Damage(TestFolder):
    """What is refused, at which byte, is what the tools say."""

    def expect_same_error(self, data: bytes, what: str) -> str:
        file = self.folder / "x.vpl"
        file.write_bytes(data)
        done = subprocess.run(
            [BIN / "vpl-inspect", "check", file], capture_output=True, text=True, check=False
        )
        try:
            bnvpl.read_vpl(file)
            problem = ""
        except bnvpl.VplError as error:
            problem = f"vpl-inspect: {error}\n"
            self.assertIn(f"{file}: byte {error.byte}: ", problem)
        self.assertEqual(problem, done.stderr, what)
        return problem

    def test_files_that_are_cut_or_too_long(self) -> None:
        data = (GOLDEN / "lit.vpl").read_bytes()
        for length in (0, 1, 8, 50, 127, 128, 200, 900, len(data) - 8, len(data) - 1):
            self.assertTrue(self.expect_same_error(data[:length], f"{length} bytes"))
        self.assertTrue(self.expect_same_error(data + b"\0", "a byte too many"))

    def test_fields_of_the_header_and_the_directory(self) -> None:
        for name, at, value in (
            ("lit", 0, b"\n"), ("lit", 0, b"\x09"), ("lit", 8, b"\0"), ("lit", 8, b"\xff"),
            ("lit", 12, b"\0"), ("lit", 12, b"\4"), ("lit", 12, b"\2"), ("lit", 16, b"\3"),
            ("lit", 16, b"\xff" * 8), ("lit", 32, b"\xff" * 8), ("lit", 32, b"\1"),
            ("lit", 40, b"\xff" * 8), ("lit", 48, b"\0"), ("lit", 56, b"\1"), ("lit", 56, b"\x20"),
            ("lit", 60, b"\1"), ("lit", 64, struct.pack("<d", -1)), ("lit", 97, b"\1"),
            ("lit", 88, struct.pack("<d", 1.5)), ("lit", 88, struct.pack("<d", np.nan)),
            ("lit", 72, struct.pack("<d", np.nan)), ("lit", 80, struct.pack("<d", np.inf)),
            ("lit", 130, b"x"), ("lit", 128 + 64 * 8 + 28, b"\6"), ("lit", 128 + 50, b"x"),
            ("methods", 128 + 64 * 5, b"R"), ("methods", 128 + 64 * 6, b"rich.lobes\0"),
            ("methods", 128 + 64 * 5 + 20, b"x"), ("methods", 128 + 64 * 5 + 24, b"\4"),
            ("methods", 128 + 64 * 5 + 28, b"\0"), ("methods", 128 + 64 * 5 + 28, b"\3"),
            ("methods", 128 + 64 * 5 + 32, b"\1"), ("methods", 128 + 64 * 5 + 40, b"\1"),
            ("methods", 128 + 64 * 5 + 48, b"\0"), ("methods", 128 + 64 * 5 + 60, b"x"),
        ):  # fmt: skip
            data = (GOLDEN / f"{name}.vpl").read_bytes()
            damaged = with_checksum(data[:at] + value + data[at + len(value) :])
            if at == layout.CHECKSUM_AT:
                damaged = data[:at] + b"\0" + data[at + 1 :]
            what = f"{name}, {value!r} at {at}"
            self.assertTrue(self.expect_same_error(damaged, what), what)

    def test_values_of_each_column(self) -> None:
        refused = set()
        for stem, names in (("lit", columns.COLUMNS), ("methods", ["rich.lobes", "rich.seeds"])):
            data = (GOLDEN / f"{stem}.vpl").read_bytes()
            for column, name in enumerate(bnvpl.read_vpl(GOLDEN / f"{stem}.vpl").columns):
                at = layout.entry_at(column)
                offset, size = struct.unpack("<2Q", data[at + 32 : at + 48])
                for value in (np.nan, -1.0, 5e9) if name in names else ():
                    begin = offset + size - 4
                    damaged = data[:begin] + struct.pack("<f", value) + data[begin + 4 :]
                    if self.expect_same_error(with_checksum(damaged), f"{name} = {value}"):
                        refused.add(name)
        self.assertEqual({*columns.COLUMNS, "rich.lobes"} - refused, {"id", "photons"})

    def test_random_bytes(self) -> None:
        rng = random.Random(1)
        data = (GOLDEN / "lit.vpl").read_bytes()
        for _ in range(15):
            at, bit = rng.randrange(len(data)), 1 << rng.randrange(8)
            flipped = data[:at] + bytes([data[at] ^ bit]) + data[at + 1 :]
            self.assertTrue(self.expect_same_error(flipped, f"byte {at} ^ {bit}"))
            self.expect_same_error(with_checksum(flipped), f"byte {at} ^ {bit}, checksum repaired")

    def test_an_unverified_read_still_checks_the_layout(self) -> None:
        data = (GOLDEN / "lit.vpl").read_bytes()
        file = self.folder / "x.vpl"
        file.write_bytes(data[:0x4C0] + b"\xff" * 12 + data[0x4CC:])
        self.assertTrue(np.isnan(bnvpl.read_vpl(file, verify=False).flux[0]).all())
        file.write_bytes(data[:-1])
        with self.assertRaisesRegex(bnvpl.VplError, "byte 1607: cut short"):
            bnvpl.read_vpl(file, verify=False)


class Refused(TestFolder):
    """Nothing is written that the tools cannot read."""

    def expect_refused(self, vpls: bnvpl.Vpls, problem: str) -> None:
        file = self.folder / "x.vpl"
        file.write_bytes((GOLDEN / "lit.vpl").read_bytes())
        with self.assertRaisesRegex(ValueError, problem):
            bnvpl.write_vpl(file, vpls)
        self.assertEqual(file.read_bytes(), (GOLDEN / "lit.vpl").read_bytes())
        self.assertEqual([p.name for p in self.folder.iterdir()], ["x.vpl"])

    def test_values_shapes_and_names(self) -> None:
        for name, values, problem in (
            ("flux", [[1, 2, 4], [0, -1, 0]], "column flux, row 1: negative"),
            ("normal", [[0, 0, 1], [0, 0, 2]], "column normal, row 1: not of unit length"),
            ("position", [[0, 0, 1e39], [0, 0, 2]], "position, row 0: not a finite number"),
            ("first_bounce_flux", [[9, 0, 0], [0, 0, 0]], "row 0: above the flux"),
            ("flux", [[1, 2, 4]], r"column flux has the shape \(1, 3\), expected \(2, 3\)"),
            ("photons", [-1, 3], "column photons has values that uint64 cannot hold"),
            ("photons", [1.5, 3], "column photons has values that uint64 cannot hold"),
            ("emit_normal", np.zeros((2, 65, 3)), "65 points a row, not 1 to 64"),
            (
                "emit_normal",
                np.repeat([[[0, 0, 1]], [[0, 1, 0]]], 2, axis=1),
                "points a row: emit_position has 1, emit_normal has 2",
            ),
            ("heat", [1, 2], "a method's column needs a name such as rich.lobes"),
            ("mine.heat", np.zeros((2, 1025)), "1025 components, not 1 to 1024"),
            ("mine.heat", [1.0, np.nan], "column mine.heat, row 1: not a finite number"),
            ("position", "abc", "column position has values that are no real numbers"),
            ("flux", [["1", "2", "4"]] * 2, "column flux has values that are no real numbers"),
            ("position", 1.0, "column position is one value, not a row for each VPL"),
        ):
            vpls = bnvpl.read_vpl(GOLDEN / "lit.vpl")
            vpls[name] = np.asarray(values)
            self.expect_refused(vpls, problem)

    def test_header_and_provenance(self) -> None:
        vpls = bnvpl.read_vpl(GOLDEN / "lit.vpl")
        vpls.reach = -1
        self.expect_refused(vpls, "reach is negative")
        vpls = bnvpl.read_vpl(GOLDEN / "lit.vpl")
        vpls.indirect_share = 2
        self.expect_refused(vpls, "share of indirect light is not 0 to 1")
        vpls = bnvpl.read_vpl(GOLDEN / "lit.vpl")
        vpls.provenance.append({"tool": np.nan})
        self.expect_refused(vpls, "provenance is no list of objects")
        vpls = bnvpl.read_vpl(GOLDEN / "lit.vpl")
        vpls.stage = "eliminated"
        self.expect_refused(vpls, "column flux is beyond stage eliminated")
        del vpls.columns["albedo"]
        self.expect_refused(vpls, "need the column albedo")
        vpls.stage = "done"
        self.expect_refused(vpls, "stage 'done' is none of candidates, eliminated, lit")
        vpls = bnvpl.read_vpl(GOLDEN / "lit.vpl")
        vpls.scene_hash = "cornell"
        self.expect_refused(vpls, "scene_hash 'cornell' is not 16 hex digits")

    def test_an_attribute_that_no_file_would_keep(self) -> None:
        vpls = bnvpl.read_vpl(GOLDEN / "lit.vpl")
        with self.assertRaisesRegex(AttributeError, "no attribute fluxx; did you mean flux?"):
            vpls.fluxx = vpls.flux * 2  # type: ignore[attr-defined]
        with self.assertRaisesRegex(AttributeError, r"no attribute heat; write vpls\["):
            vpls.heat = vpls.radius  # type: ignore[attr-defined]
        vpls.flux, vpls.reach, vpls.stage = vpls.flux * 2, 1.0, "lit"
        self.assertEqual(vpls["flux"].tolist(), [[2, 4, 8], [0, 0, 0]])

    def test_files_that_are_missing_or_none(self) -> None:
        with self.assertRaises(FileNotFoundError):
            bnvpl.read_vpl(Path("missing.vpl"))
        with self.assertRaisesRegex(ValueError, "not a regular file"):
            bnvpl.read_vpl(self.folder)


if __name__ == "__main__":
    main()
