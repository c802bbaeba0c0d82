#!/usr/bin/python3
"""Runs all tests of the report: what the scripts read and write, and the page in Chromium.

Needs chromium, chromium-driver, python3-selenium, python3-openimageio, python3-matplotlib.
"""

import unittest

from test_explorer import ExplorerTest, ListTest  # noqa: F401
from test_inputs import InputTest  # noqa: F401
from test_page import PageTest  # noqa: F401
from test_table import TableTest  # noqa: F401
from test_viewer import ViewerTest  # noqa: F401

if __name__ == "__main__":
    unittest.main()
