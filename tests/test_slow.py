"""The list of slow tests: made of what pytest measured, and of tests that there are."""

import re
from pathlib import Path

from slow import NAMES, slow

ROOT = Path(__file__).parents[1]


def test_every_slow_test_is_there() -> None:
    for name in NAMES:
        file, *_, function = name.split("::")
        text = (ROOT / file).read_text(encoding="utf-8")
        assert re.search(rf"^ *def {function}\(", text, re.MULTILINE), f"{name}: make tests/slow.txt anew"


def test_slow_is_a_case_of_half_a_second_or_many_that_take_two_together() -> None:
    log = """
        0.40s call     tests/a.py::test_long[1]
        0.15s setup    tests/a.py::test_long[1]
        0.40s call     tests/a.py::TestB::test_quick[x]
        0.30s call     tests/a.py::test_many[1]
        1.10s call     tests/a.py::test_few
        tests/a.py::test_not_a_duration PASSED
    """ + "".join(f"0.30s call tests/a.py::test_many[{index}]\n" for index in range(2, 9))
    assert slow(log.splitlines()) == {"tests/a.py::test_long", "tests/a.py::test_few", "tests/a.py::test_many"}
