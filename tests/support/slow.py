"""Which tests are slow, as measured: `pytest -m "not slow"` leaves them out.

    pytest -vv --durations=0 >log ; python tests/support/slow.py <log >tests/slow.txt

A test is slow when one of its cases takes more than LIMIT. Names are those of functions: a file with a slow test may
have quick ones, and names survive new parameters.
"""

from __future__ import annotations

import re
import sys
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

LIMIT = 0.5  # s for setup, call and teardown, on the machine that measures
MOST = 2.0  # s for all the cases of a function together
_FILE = Path(__file__).parents[1] / "slow.txt"
_LINE = re.compile(r"([\d.]+)s (?:call|setup|teardown) +(tests/\S+?\.py::.+)")


def name_of(node: str) -> str:
    """`tests/x.py::Class::test` of a node's id, without its parameters."""
    return node.partition("[")[0]


def slow(lines: Iterable[str]) -> set[str]:
    """The slow tests of a log of pytest's durations."""
    cases: Counter[str] = Counter()
    for line in lines:
        if found := _LINE.match(line.strip()):
            cases[found[2]] += float(found[1])  # type: ignore[assignment]  # seconds, and a Counter adds them too
    functions: Counter[str] = Counter()
    for case, seconds in cases.items():
        functions[name_of(case)] += seconds
    return {name_of(case) for case, seconds in cases.items() if seconds > LIMIT} | {
        name for name, seconds in functions.items() if seconds > MOST
    }


NAMES = frozenset(_FILE.read_text(encoding="utf-8").split())

if __name__ == "__main__":
    sys.stdout.write("".join(f"{name}\n" for name in sorted(slow(sys.stdin))))
