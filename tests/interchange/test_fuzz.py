"""A thousand hostile files of each format: refused in one line, or read; `benchmarks/fuzz_interchange.py` has more."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from interchange_fuzz import READERS, attack

from teleop.interchange.child import limit

LIBRARIES = ("usd", "otio")  # in C++, and opentimelineio crashes on 3 of 100 000: in a child, as the program reads them


@pytest.mark.parametrize("name", [name for name in READERS if name not in LIBRARIES])
def test_whatever_a_file_is_nothing_else_is_raised(name: str, tmp_path: Path) -> None:
    attack(name, 1000, 20261129, tmp_path)


@pytest.mark.parametrize("name", LIBRARIES)
def test_whatever_a_file_is_its_library_gets_no_further_than_its_child(name: str, tmp_path: Path) -> None:
    attack(name, 1, 0, tmp_path)  # loads the library
    child = os.fork()
    if child == 0:
        limit()
        code = 1
        try:
            attack(name, 1000, 20261129, tmp_path, binary=False)
            code = 0
        finally:
            os._exit(code)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) <= 0, "a Python error; below 0 is a signal"
