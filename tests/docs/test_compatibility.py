"""The compatibility table: made from reports, up to date, empty at first, and without serial numbers."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from made_findings import FOUND

from teleop.core.errors import TeleopError

SCRIPT = Path(__file__).parents[2] / "docs" / "make_compatibility.py"
_spec = importlib.util.spec_from_file_location("make_compatibility", SCRIPT)
assert _spec
assert _spec.loader
compatibility = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(compatibility)


def test_the_page_is_that_of_the_reports() -> None:
    assert subprocess.run([sys.executable, str(SCRIPT), "--check"], timeout=100).returncode == 0


def test_without_reports_it_says_so() -> None:
    assert "The table is empty: there is no report of a real device yet." in compatibility.page([])


def test_a_row_for_each_report_and_what_differs(tmp_path: Path) -> None:
    (tmp_path / "rs3.json").write_text(FOUND.to_json())
    text = compatibility.page(compatibility.reports(tmp_path))
    assert "| gimbal | RS 3 Pro | 03.01.00.10 | slcan:/dev/ttyACM0 | 2026-11-29 | 0.2.0 | 3 | 1 | 1 |" in text
    assert "| Sign of pan in speed commands (0E 01) | 1 | -1 |" in text
    assert "empty" not in text


def test_text_of_a_report_makes_no_markup() -> None:
    text = compatibility.page([replace(FOUND, model="a|b <script>\n# x")])
    assert "a\\|b \\<script\\> \\# x" in text


def test_a_report_with_serial_numbers_is_refused(tmp_path: Path) -> None:
    (tmp_path / "rs3.json").write_text(FOUND.to_json(serials=True))
    with pytest.raises(TeleopError, match=r"rs3\.json: has serial numbers: write the report again without --serial"):
        compatibility.reports(tmp_path)
