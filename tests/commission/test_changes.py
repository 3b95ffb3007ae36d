"""What changed between two commissionings: values and signs, what is seen only now or only before, and no noise."""

from __future__ import annotations

import pytest
from made_findings import COMMAND, FOUND, LAG, SIGN, UPDATED

from teleop.commission.changes import Kind, changes, heading, shown, written
from teleop.commission.findings import Findings, Subject


def test_the_changes_after_an_update() -> None:
    found = [(change.title, change.kind, shown(change.before), shown(change.now)) for change in changes(FOUND, UPDATED)]
    assert found == [
        ("Sign of pan in speed commands (0E 01)", Kind.VALUE, "-1", "1"),
        ("A focus motor answers <0E 12>", Kind.NEW, "not seen", "yes"),
        ("Limit of the gimbal: pitch max", Kind.GONE, "145 deg", "not seen"),
    ]
    assert heading(FOUND, UPDATED) == [("firmware", "03.01.00.10", "04.00.00.00")]


def test_nothing_changes_between_a_report_and_itself() -> None:
    assert not changes(FOUND, Findings.from_json(FOUND.to_json()))
    assert not heading(FOUND, FOUND)


@pytest.mark.parametrize(
    ("subject", "before", "now", "changed"),
    [
        (LAG, 0.080, 0.086, False),
        (LAG, 0.002, 0.009, False),
        (LAG, 0.080, 0.160, True),
        (SIGN, 1, -1, True),
        (COMMAND, True, False, True),
        (Subject("x", "x"), "stop", "refuse", True),
        (Subject("x", "x", None, "deg"), -0.05, 0.05, False),
        (Subject("x", "x", 145.0, "deg"), 145.0, 155.0, True),
    ],
)
def test_measured_numbers_may_differ_a_little(subject: Subject, before: float, now: float, changed: bool) -> None:
    reports = [Findings("rig", facts=(subject.found(value, "measured"),)) for value in (before, now)]
    assert bool(changes(*reports)) is changed


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (True, "", "yes"),
        (False, "", "no"),
        (None, "s", "-"),
        (0.0812345, "s", "0.08123 s"),
        (145.0, "deg", "145 deg"),
        (1000000, "bit/s", "1000000 bit/s"),
    ],
)
def test_values_as_people_read_them(value: bool | float | None, unit: str, text: str) -> None:
    assert written(value, unit) == text
