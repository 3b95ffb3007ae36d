"""A take in arrays."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from made_takes import write_take

from teleop.core.axes import Axis, State
from teleop.core.errors import UsageError
from teleop.core.events import Action
from teleop.recording.reader import Take, read_take


@pytest.fixture
def take(tmp_path: Path) -> Take:
    motion = {Axis.PAN: lambda time: State(2 * time, 2.0), Axis.TILT: lambda _time: State(5.0)}
    acts = {50: [Action.RECORD]}
    path = write_take(tmp_path / "t.mcap", motion, 1, measured={Axis.PAN: lambda time: 2 * time - 0.1}, acts=acts)
    return read_take(path)


def test_motion_readings_and_actions_have_their_times(take: Take) -> None:
    assert (list(take.axes), take.duration) == ([Axis.PAN, Axis.TILT], pytest.approx(1.0))
    assert take.motion[Axis.PAN][:2, 50] == pytest.approx([1.0, 2.0])
    assert take.state(Axis.TILT, 3) == State(5.0)
    times, positions = take.measured[Axis.PAN]
    assert positions == pytest.approx(2 * times - 0.1)
    assert Axis.TILT not in take.measured
    [(time, action)] = take.actions
    assert (time, action["action"]) == (pytest.approx(0.5), "record")
    assert (take.cut, take.remark, take.ended) == (False, "", "done")


def test_a_take_is_shown_in_a_line_at_a_prompt(take: Take) -> None:
    assert repr(take) == f"Take({str(take.path)!r}: {take.about.title} on {take.about.rig}, pan, tilt, 1.00 s)"


def test_a_frame_has_readings_between_the_first_and_the_last_only(take: Take) -> None:
    pytest.importorskip("pandas", reason="to_frame is for those who have pandas")
    frame = take.to_frame()
    assert list(frame.columns)[:4] == ["pan", "pan_velocity", "pan_acceleration", "pan_measured"]
    assert np.isclose(frame["pan_measured"].iloc[50], 0.9)


def test_without_pandas_a_frame_is_refused(take: Take, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(UsageError, match="pip install pandas"):
        take.to_frame()
