"""What the keys of a sink mean, and which values they take."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import ValidationError

from teleop.config.flight_modes import FLIGHT_MODES, combination_of
from teleop.config.sinks_section import FlightSection, GimbalSection
from teleop.core.axes import Axis
from teleop.dji.drone.movement import COMBINATIONS, Combination, Horizontal, ReferenceFrame, Vertical, Yaw

FULL_SCALE = {"horizontal": 2.0, "vertical": 1.0, "yaw": 20.0}


def gimbal(**keys: Any) -> GimbalSection:
    return GimbalSection.model_validate({"type": "gimbal", "link": "gimbal", "mode": "position", "rate": 50, **keys})


def flight(**keys: Any) -> FlightSection:
    section = {"type": "flight", "link": "drone", "mode": "velocity-body", "full_scale": FULL_SCALE, **keys}
    return FlightSection.model_validate(section)


def test_an_angle_that_the_mapping_leaves_out_is_not_driven() -> None:
    assert gimbal().axes == [Axis.PAN, Axis.ROLL, Axis.TILT]
    assert gimbal(mapping={"yaw": "roll", "pitch": "tilt"}).axes == [Axis.ROLL, None, Axis.TILT]


@pytest.mark.parametrize(
    ("keys", "line"),
    [
        ({"mode": "position"}, "report_signs: {pan: -1}"),
        ({"mode": "speed"}, "speed_signs: {pan: -1}"),
        ({"mode": "stick", "speed_signs": {"tilt": -1, "pan": -1}}, "speed_signs: {tilt: -1, pan: 1}"),
        ({"mode": "position", "signs": {"pan": -1}}, "report_signs: {pan: 1}"),
    ],
)
def test_the_line_for_an_axis_that_goes_the_other_way_turns_the_sign_of_its_mode(
    keys: dict[str, Any], line: str
) -> None:
    assert gimbal(**keys).sign_line(Axis.PAN) == line


def test_full_deflection_gives_the_axiss_own_velocity_unless_it_is_written() -> None:
    sticks = gimbal(mode="stick", full_stick={"pan": 30.0})
    assert [sticks.full(axis, 90.0) for axis in (Axis.PAN, Axis.TILT)] == [30.0, 90.0]


@pytest.mark.parametrize(
    ("key", "value"),
    [("rate", 30), ("rate", True), ("signs", {"pan": 0}), ("signs", {"pan": True}), ("full_stick", {"pan": 0.0})],
)
def test_a_value_that_no_gimbal_has_is_refused_at_its_key(key: str, value: object) -> None:
    with pytest.raises(ValidationError) as caught:
        gimbal(**{key: value})
    assert {error["loc"][0] for error in caught.value.errors()} == {key}


def test_the_keys_of_a_flight_section_are_one_of_the_drones_modes() -> None:
    section = flight(mode="tilt-ground", vertical="height", yaw="angle")
    assert combination_of(section.mode, section.vertical, section.yaw) == Combination(
        Horizontal.TILT, Vertical.POSITION, Yaw.ANGLE
    )
    assert FLIGHT_MODES[section.mode][1] is ReferenceFrame.GROUND
    made = {
        combination_of(mode, up, yaw)
        for mode in FLIGHT_MODES
        for up in ("velocity", "height")
        for yaw in ("rate", "angle")
    }
    assert made == {each for each in COMBINATIONS if each.vertical is not Vertical.THRUST}
