"""The plan ahead of a tick: foreseen where a sequence plays, guessed where a hand moves it."""

import math

import pytest

from teleop.core.axes import Axis, Motion, State
from teleop.devices.gimbal.outlook import outlook


def wave(time: float) -> Motion:
    return {Axis.PAN: State(math.sin(time), math.cos(time), -math.sin(time))}


def test_what_is_foreseen_is_what_comes() -> None:
    plan = outlook(Axis.PAN, 2.0, wave(2.0)[Axis.PAN], wave)
    assert plan.at(0.3) == pytest.approx(wave(2.3)[Axis.PAN])


def test_a_trim_beside_it_goes_on_as_it_is() -> None:
    here = State(*(a + b for a, b in zip(wave(2.0)[Axis.PAN], (1.0, 10.0, 4.0), strict=True)))
    at = outlook(Axis.PAN, 2.0, here, wave).at(0.5)
    assert at == pytest.approx(tuple(a + b for a, b in zip(wave(2.5)[Axis.PAN], (1 + 5 + 0.5, 12.0, 4.0), strict=True)))


@pytest.mark.parametrize("foreseen", [None, lambda _time: {}])
def test_a_hand_is_taken_to_go_on(foreseen: object) -> None:
    assert outlook(Axis.PAN, 2.0, State(1.0, 10.0, 4.0), foreseen).at(0.5) == State(6.5, 12.0, 4.0)  # type: ignore[arg-type]
