"""The keys `tension` and `overshoot` of a sequence: what they may be, and what they do."""

from __future__ import annotations

from pathlib import Path

import pytest

from teleop.config.documents.document import DocumentError
from teleop.core.axes import Axis
from tests.support.sequences import load, problems_of

SWING = "keyframes:\n  - {at: 0, pan: 0}\n  - {at: 5, pan: -20}\n  - {at: 6, pan: 60}\n  - {at: 16, pan: 58}\n"
KEYS = "keyframes: [{at: 0, pan: 0}]\n"


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ("tension: 1.5", "1:10: tension must be 0 to 1, or even, not 1.5"),
        ("tension: odd", "1:10: tension must be 0 to 1, or even, not 'odd'"),
        ("overshoot: -1", "1:12: overshoot must be a distance such as 2, or {pan: 2}, not -1"),
        ("overshoot: {yaw: 2}", "1:18: overshoot.yaw: unknown axis; did you mean pan?"),
        ("overshoot: {pan: much}", "1:18: overshoot.pan must be a distance such as 2, not 'much'"),
    ],
)
def test_what_they_may_not_be(tmp_path: Path, line: str, problem: str) -> None:
    assert problems_of(tmp_path, f"{line}\n{KEYS}") == [f"shoot.yaml:{problem}"]


def test_more_overshoot_than_is_tolerated_is_an_error_and_less_a_warning(tmp_path: Path) -> None:
    with pytest.raises(DocumentError, match=r"shoot.yaml:5:5: pan needs 1.* \(it would overshoot by 1\."):
        load(tmp_path, SWING)
    for line in ("overshoot: 3", "overshoot: {pan: 3}"):
        sequence = load(tmp_path, f"{line}\n{SWING}")
        assert [" overshoots by 1." in warning for warning in sequence.warnings] == [True, True]
    with pytest.raises(DocumentError, match="would overshoot"):
        load(tmp_path, "overshoot: {tilt: 3}\n" + SWING)


def test_an_included_move_keeps_its_own(tmp_path: Path) -> None:
    (tmp_path / "inner.yaml").write_text("overshoot: 3\ntension: 0\n" + SWING)
    outer = load(tmp_path, "tension: 1\ninclude:\n  - {move: ./inner.yaml, at: 0}\n")
    first = outer.keys[Axis.PAN][0]
    assert (first.overshoot, first.tension) == (3, 0)


def test_a_stretched_move_has_no_overshoot(tmp_path: Path) -> None:
    (warning,) = load(tmp_path, "fit: stretch\n" + SWING).warnings
    assert "fit stretched it 1.2" in warning
