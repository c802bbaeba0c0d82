#!/usr/bin/python3
"""Tests that the package can be installed, has types, and has the version of the tools.

test_package.py BIN       # folder of the executables
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys

from support import PACKAGE, ROOT, TestFolder, main

# isort: split
import bnvpl


class Package(TestFolder):
    def test_the_version_is_that_of_the_project(self) -> None:
        cmake = (ROOT / "CMakeLists.txt").read_text()
        found = re.search(r"project\(bnvpl VERSION ([\d.]+)", cmake)
        assert found
        self.assertEqual(bnvpl.__version__, found[1])

    def test_installs_with_its_types(self) -> None:
        source, target = self.folder / "source", self.folder / "target"
        shutil.copytree(PACKAGE, source, ignore=shutil.ignore_patterns("__pycache__"))
        pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet", "install"]
        plain = ["--no-build-isolation", "--no-deps", "--no-index", "--root-user-action=ignore"]
        subprocess.run([*pip, *plain, "--target", str(target), str(source)], check=True)
        self.assertTrue((target / "bnvpl/py.typed").exists())
        code = "import bnvpl; print(bnvpl.__file__, bnvpl.read_vpl(r'''%s''').flux.shape)"
        done = subprocess.run(
            [sys.executable, "-c", code % (ROOT / "tests/formats/golden/lit.vpl")],
            env={**os.environ, "PYTHONPATH": str(target)},
            cwd=self.folder,
            capture_output=True,
            text=True,
            check=True,
        )
        self.assertEqual(done.stdout, f"{target}/bnvpl/__init__.py (2, 3)\n")
        installed = next(target.glob("bnvpl-*.dist-info")).name
        self.assertEqual(installed, f"bnvpl-{bnvpl.__version__}.dist-info")

    def test_images_and_checksums_are_optional(self) -> None:
        code = (
            "import sys; sys.modules['OpenImageIO'] = sys.modules['xxhash'] = None; import bnvpl\n"
            f"bnvpl.read_vpl(r'''{ROOT}/tests/formats/golden/lit.vpl''', verify=False)\n"
            "for read, name in (bnvpl.read_vpl, 'lit.vpl'), (bnvpl.read_exr, 'none.exr'):\n"
            "    try: read(r'''%s/tests/formats/golden/''' + name)\n"
            "    except ImportError as error: print(error)\n"
        )
        done = subprocess.run(
            [sys.executable, "-c", code % ROOT], capture_output=True, text=True, check=True
        )
        self.assertIn("python3-xxhash", done.stdout)
        self.assertIn("python3-openimageio", done.stdout)


if __name__ == "__main__":
    main()
