"""The page of a commissioning on terminals of several sizes: nothing of it is cut off in width."""

from __future__ import annotations

import pytest

from teleop.cli.screens.commission_view import CommissionView
from teleop.commission.findings import Fact, Verdict
from teleop.commission.page import Page, Stage

TROUBLE = "gimbal on udp_multicast:239.74.163.91 does not answer: is it on, is the cable in?"
ABOUT = "pan goes 2 deg to one side, slowly (2 deg/s), and back, and it ends where it began."
MISSING = "suspected missing: 120 ohm across CANH and CANL"
MODELS = {"1": "RS 2", "2": "RS 3 Pro", "3": "RS 4", "4": "RS 4 Pro", "5": "RS 5", "o": "another", "space": "STOP"}


def drawn(page: Page, width: int, height: int) -> list[str]:
    rows = CommissionView("My rig", lambda: page)._draw(width, height).fitted(width, height)
    assert len(rows) == height
    assert all(row.cell_len <= width for row in rows)
    return [row.plain.rstrip() for row in rows]


def words(rows: list[str]) -> str:
    return " ".join(" ".join(rows).split())


@pytest.mark.parametrize(("width", "height"), [(80, 24), (120, 40), (40, 20), (32, 24)])
def test_what_will_happen_what_is_wrong_and_all_keys_are_on_the_screen(width: int, height: int) -> None:
    page = Page("a", 9, 31, "Pan", Stage.ASKING, (ABOUT,), question="Which model is it?", trouble=TROUBLE, keys=MODELS)
    seen = words(drawn(page, width, height))
    for text in (ABOUT, TROUBLE, "Which model is it?", *(f"{key} {does}" for key, does in MODELS.items())):
        assert text in seen


def test_a_key_and_what_it_does_are_never_on_two_lines() -> None:
    rows = drawn(Page("a", 1, 2, "Pan", Stage.ASKING, question="Which?", keys=MODELS), 20, 12)
    assert {"1 RS 2", "2 RS 3 Pro", "4 RS 4 Pro", "space STOP"} <= {
        key.strip() for row in rows for key in row.split("   ")
    }


def test_a_long_value_has_a_line_of_its_own_and_its_verdict_stays() -> None:
    fact = Fact("bus.termination", "Termination of the bus", "no sign", MISSING, "", Verdict.DIFFERENT, "3 errors")
    short = Fact("a.b", "Sign of pan", 1, -1, "", Verdict.DIFFERENT, "")
    rows = drawn(Page("replies", 3, 31, "Replies", Stage.SHOWN, facts=(fact, short)), 80, 24)
    begin = next(number for number, row in enumerate(rows) if "Termination" in row)
    assert rows[begin].endswith("different")
    assert rows[begin + 1].strip() == MISSING
    assert rows[begin + 2].split() == ["Sign", "of", "pan", "-1", "different"]
