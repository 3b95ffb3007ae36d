"""A timelapse on a gimbal that is late and was never measured: its plan is known ahead, and leads what is sent."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
import pytest
from shoot_bench import Stage

from teleop.config.sinks_section import GimbalSection
from teleop.core.axes import Axis
from teleop.core.events import Tick
from teleop.core.run_state import Result
from teleop.devices import rig
from teleop.sim.gimbal.dynamics import Dynamics

LATE = Dynamics(lag=0.12, dead_time=0.08)


@pytest.mark.parametrize(
    ("interval", "exposure", "more", "identified"),
    [
        ("1s", "0.2s", "  mode: continuous\n", 2.0),
        ("7s", "1.5s", "  mode: shoot-move-shoot\n  blur: 0.3\n", 6.0),
    ],
)
def test_a_late_gimbal_is_led_by_the_plan_of_a_timelapse(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, interval: str, exposure: str, more: str, identified: float
) -> None:
    stage = Stage(tmp_path, monkeypatch)
    monkeypatch.setattr(rig, "SimulatedGimbal", partial(rig.SimulatedGimbal, dynamics=LATE))
    sinks = [
        each.model_copy(update={"mode": "speed", "delay": None}) if isinstance(each, GimbalSection) else each
        for each in stage.profile.sinks
    ]
    stage.profile = stage.profile.model_copy(update={"sinks": sinks})
    stage.write(3, interval, more, exposure)
    planned: list[tuple[float, float]] = []

    def watch(tick: Tick) -> None:
        planned.append((tick.time, tick.motion[Axis.PAN].position))

    stage.watch = watch
    assert stage.shoot().result is Result.DONE
    assert len(stage.shots) == 3
    times, places = np.array(planned).T
    measured = np.array(stage.gimbals[0].places)
    errors = np.interp(times, measured[:, 0], measured[:, 1]) - places
    assert np.abs(errors[times > times[0] + identified]).max() < 0.4  # without its plan it was 0.8 deg and more
