"""The gesture that starts the motors: both sticks down and apart, or down and together (Virtual RC page, Example)."""

from __future__ import annotations

import pytest

from teleop.sim.drone.controls import Controls


@pytest.mark.parametrize("roll", [-1.0, 1.0])
def test_both_sticks_down_and_to_opposite_sides_are_the_gesture(roll: float) -> None:
    assert Controls(roll=roll, pitch=-1.0, throttle=-1.0, yaw=-roll).in_corners


@pytest.mark.parametrize(
    "sticks",
    [
        Controls(),
        Controls(roll=1.0, pitch=-1.0, throttle=-1.0, yaw=1.0),  # to the same side
        Controls(roll=-1.0, pitch=1.0, throttle=-1.0, yaw=1.0),  # one is up
        Controls(roll=-1.0, pitch=-1.0, throttle=1.0, yaw=1.0),
        Controls(roll=-0.9, pitch=-1.0, throttle=-1.0, yaw=1.0),  # not all the way
        Controls(roll=-1.0, pitch=-0.9, throttle=-1.0, yaw=1.0),
        Controls(roll=-1.0, pitch=-1.0, throttle=-1.0, yaw=0.9),
    ],
)
def test_anything_else_is_none(sticks: Controls) -> None:
    assert not sticks.in_corners
