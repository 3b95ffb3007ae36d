"""A run that learns from pass to pass on a simulated gimbal, and what teaches it nothing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import pytest
from learning_bench import FAST, SLOW, learned, rig

import teleop
from teleop.core.axes import Axis
from teleop.core.events import Tick
from teleop.core.operator_input import Command, Held, Press
from teleop.core.run_state import Result
from teleop.inputs.keyboard import Keyboard
from teleop.learning.correction_file import read_correction
from teleop.learning.pass_traces import CHANGED

PROFILE = """
name: Bench
links: {gimbal: "sim:"}
axes: {pan: {min: -90, max: 90, velocity: 120, acceleration: 240, jerk: 1200}}
sinks: [{type: gimbal, link: gimbal, mode: speed, rate: 50, simulated: {lag: 0.08, dead_time: 0.03}}]
"""
QUICK = {"keyframes": [{"at": 0, "pan": 0}, {"at": 2, "pan": 40}, {"at": 4, "pan": -5}]}
LATE = {"lag": 0.08, "dead_time": 0.03, "backlash": 0.05}


class Keys:
    """The keys of a terminal: each press at a time (s) of the loop's clock."""

    name = "keys"

    def __init__(self, presses: Sequence[tuple[float, Command]]) -> None:
        self._presses = list(presses)

    def read(self, now: float) -> Held:
        due = [Press(command) for at, command in self._presses if at <= now + 1e-6]
        self._presses = [(at, command) for at, command in self._presses if at > now + 1e-6]
        return Held(presses=due, stop="")

    def observe(self, tick: Tick) -> None: ...

    def __enter__(self) -> Keys:
        return self

    def __exit__(self, *_: object) -> None: ...


def with_keys(*presses: tuple[float, Command]) -> Any:
    return lambda run: replace(run, keys=cast(Keyboard, Keys(presses)))


@pytest.mark.parametrize(
    ("gimbal", "mode", "move"),
    [(LATE, "speed", FAST), ({**LATE, "gain": 0.9, "drift": 0.5}, "speed", SLOW), (LATE, "position", FAST)],
)
def test_by_the_third_pass_a_quarter_of_the_error_is_left_or_nearly_none(
    gimbal: dict[str, float], mode: str, move: dict[str, Any], tmp_path: Path
):
    found = learned(rig(gimbal, mode, delay=0.0), move, 3, tmp_path)
    rms = found.rms()
    assert min(rms[1:]) <= max(rms[0] / 4, 0.05)
    assert sum(line.startswith("pass ") and "RMS" in line for line in found.screen.said) == 3
    best = found.learner.best[Axis.PAN]
    assert best[1].rms == min(rms)
    if found.saved:
        kept = read_correction(tmp_path / "a.learned.json")
        assert kept.best[Axis.PAN] == best[0]
        assert not kept.exceeds(found.plan.sequence.move, found.plan.profile.limits)


@pytest.mark.parametrize(
    "gimbal", [{"lag": 0.1, "dead_time": 0.03}, {"lag": 0.03, "dead_time": 0.1, "gain": 1.1, "drift": -1}]
)
def test_a_pass_in_which_the_gimbal_was_identified_does_not_correct_the_next(gimbal: dict[str, float], tmp_path: Path):
    found = learned(rig({**gimbal, "backlash": 0.05}), QUICK, 3, tmp_path)
    rms = found.rms()
    assert min(rms[1:]) <= max(rms[0] / 4, 0.05)
    same = "pass 1: pan was identified in it: the next pass has the same correction"
    assert [line for line in found.screen.said if "identified in it" in line] == [same]


def test_a_pass_that_was_stopped_teaches_nothing(tmp_path: Path):
    stop = with_keys((6.0, Command.STOP), (7.0, Command.CLEAR), (7.5, Command.PAUSE))
    found = learned(rig(LATE, delay=0.0), FAST, 2, tmp_path, changed=stop)
    assert found.report.run.result is Result.DONE
    assert [each.ignored for each in found.learner.passes] == [CHANGED, ""]
    assert found.learner.best[Axis.PAN][0] == 2
    assert [dict(each.offsets) for each in found.saved] == [{}]  # nothing was corrected yet
    assert any(line == f"pass 1 teaches nothing: {CHANGED}" for line in found.screen.said)


def test_a_run_that_ends_in_its_first_pass_has_learned_nothing(tmp_path: Path):
    found = learned(rig(LATE), FAST, 2, tmp_path, changed=with_keys((6.0, Command.QUIT)))
    assert found.report.run.result is not Result.DONE
    assert (found.learner.passes, found.saved) == ([], [])
    assert not (tmp_path / "a.learned.json").exists()


def test_a_gimbal_that_follows_is_left_alone(tmp_path: Path):
    found = learned(rig({"lag": 0.0}, "position"), SLOW, 3, tmp_path)
    assert max(found.rms()) < 0.05
    assert all(line.startswith("pass") or "nothing more to gain" in line for line in found.screen.said)


def test_what_is_reported_is_against_the_plan_and_not_against_what_was_sent(tmp_path: Path):
    first = learned(rig(LATE, delay=0.0), FAST, 2, tmp_path)
    again = learned(rig(LATE, delay=0.0), FAST, 2, tmp_path, known=first.saved[-1])
    assert again.rms()[-2] <= max(first.rms()[0] / 4, 0.06)
    assert [each.number for each in again.learner.passes] == [1, 2, 3, 4]  # goes on from what the file has


def test_a_program_learns_and_plays_what_it_has_learned(tmp_path: Path):
    (tmp_path / "rig.yaml").write_text(PROFILE)
    with teleop.open(tmp_path / "rig.yaml", virtual=True) as opened:
        report = opened.play(FAST, passes=3, learn=True, take=tmp_path / "a.mcap")
        first, *later = (each["pan"].rms for each in report.passes)
        assert min(later) <= max(first / 4, 0.05)
        with pytest.raises(teleop.UsageError, match="already exists"):
            opened.play(FAST, passes=2, learn=tmp_path / "a.learned.json")
        with pytest.raises(teleop.UsageError, match="needs passes"):
            opened.play(FAST, learn=True, take=tmp_path / "b.mcap")
        again = opened.play(FAST, learned=tmp_path / "a.learned.json")
    assert again.axes["pan"].rms <= max(first / 4, 0.06)
    assert teleop.read_take(tmp_path / "a.mcap").about.sequence.fingerprint
