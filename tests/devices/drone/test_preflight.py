"""The appendix's conditions, for all fourteen ways to move: what wants the GPS, what is not trusted with a height."""

from __future__ import annotations

import pytest

from teleop.devices.drone.preflight import Site, mode_refusals, mode_warnings
from teleop.dji.drone.movement import COMBINATIONS, Combination, Horizontal, Vertical, Yaw

AT_HOME, GUIDED = Site(), Site(guidance=True)
INSIDE, GUIDED_INSIDE = Site(indoors=True), Site(guidance=True, indoors=True)


@pytest.mark.parametrize("combination", COMBINATIONS)
def test_horizontal_positions_and_velocities_want_a_good_gps(combination: Combination) -> None:
    def refused(site: Site, health: int | None) -> bool:
        return bool(list(mode_refusals(combination, site, health)))

    assert not refused(AT_HOME, 3)
    poor = combination.horizontal != Horizontal.TILT
    assert refused(AT_HOME, 2) is refused(AT_HOME, None) is poor
    assert refused(GUIDED, 2) is (combination.horizontal == Horizontal.POSITION), "Guidance has velocities only"


@pytest.mark.parametrize("combination", COMBINATIONS)
def test_heights_are_warned_of_near_the_ground_and_indoors(combination: Combination) -> None:
    def warned(site: Site, height: float | None) -> bool:
        return bool(list(mode_warnings(combination, site, height)))

    by_height = combination.vertical == Vertical.POSITION
    assert warned(AT_HOME, 2.9) is warned(AT_HOME, None) is warned(INSIDE, 5.0) is by_height
    assert warned(GUIDED_INSIDE, 5.0) is by_height, "too high for ultrasound"
    assert not warned(AT_HOME, 5.0)


def test_what_is_said_names_the_numbers() -> None:
    velocity = Combination(Horizontal.VELOCITY, Vertical.VELOCITY, Yaw.RATE)
    assert list(mode_refusals(velocity, AT_HOME, 1)) == [
        "GPS health is 1 of 5: horizontal velocities need 3, or Guidance declared in the profile"
    ]
    height = Combination(Horizontal.TILT, Vertical.POSITION, Yaw.RATE)
    assert list(mode_warnings(height, INSIDE, 2.0)) == [
        "indoors, without Guidance or above 3 m, the barometer misleads: a height may not be kept"
    ]
