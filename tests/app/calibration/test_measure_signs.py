"""The signs of a simulated gimbal as settings of the profile: only what is needed, beside what is there."""

from __future__ import annotations

from collections.abc import Mapping

import pytest
from silent_screen import SilentScreen, no_signals

from teleop.app.calibration.measure_signs import SignsReport, measure_signs
from teleop.app.calibration.sign_probe import Signs
from teleop.config.profile import load_profile
from teleop.config.sinks_section import GimbalSection
from teleop.core.axes import Axis
from teleop.core.clock import VirtualClock
from teleop.core.errors import UsageError
from teleop.core.run_state import Result

PAN, TILT = Axis.PAN, Axis.TILT


def settings(found: Mapping[Axis, Signs], **section: object) -> Mapping[str, Mapping[str, int]]:
    made = GimbalSection.model_validate({"type": "gimbal", "link": "g", "mode": "speed", "rate": 50, **section})
    return SignsReport(Result.DONE, [], made, found).settings


def test_a_simulated_gimbal_counts_everything_one_way():
    screen, begun = SilentScreen(), []
    report = measure_signs(
        *(load_profile("sim"), "pan", VirtualClock(), lambda axes, keys: begun.append((list(axes), keys))),
        *(no_signals, screen.notify, screen.notify, None),
        virtual=True,
    )
    assert (report.result, begun) == (Result.DONE, [([PAN], False)])
    assert report.signs == {PAN: Signs(1, 1)}
    assert report.settings == {"signs": {"pan": 1}, "speed_signs": {"pan": 1}}


@pytest.mark.parametrize("axis", ["focus", "elbow"])
def test_an_axis_that_no_gimbal_moves_is_refused(axis: str):
    with pytest.raises(UsageError, match=f"--axis {axis}: no gimbal of Simulated rig moves it"):
        measure_signs(load_profile("sim"), axis, VirtualClock(), print, no_signals, print, print, None, virtual=True)


def test_speeds_and_reports_are_made_to_agree_with_positions():
    assert settings({PAN: Signs(1, -1)}) == {"signs": {"pan": 1}, "speed_signs": {"pan": -1}}
    assert settings({PAN: Signs(-1, 1)}) == {
        "signs": {"pan": 1},
        "speed_signs": {"pan": -1},
        "report_signs": {"pan": -1},
    }


def test_the_signs_of_axes_that_were_not_measured_stay():
    found = settings({PAN: Signs(1, 1)}, signs={"tilt": -1}, speed_signs={"roll": -1})
    assert found == {"signs": {"tilt": -1, "pan": 1}, "speed_signs": {"roll": -1, "pan": 1}}


def test_a_gimbal_that_ignores_speeds_gets_no_sign_for_them():
    assert settings({PAN: Signs(1, 0)}) == {"signs": {"pan": 1}}
