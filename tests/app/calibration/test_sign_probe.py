"""The probe's own rules: room, runaway, what it sends when halted, and that speed control is always given back."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

import pytest

from teleop.app.calibration.sign_probe import ROOM, RUNAWAY, SignProbe
from teleop.config.wiring import Wiring
from teleop.core.axes import Axis, Limits, Reading, State
from teleop.core.errors import DeviceError
from teleop.core.events import Tick
from teleop.devices.connection import Connection
from teleop.devices.gimbal.speed import ZEROS
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.message import Message

PAN = Axis.PAN
LIMITS = {PAN: Limits(-10, 10, 60, 120, 600)}
WIRING = Wiring([PAN, None, None])
PERIOD = 0.01


class Sent:
    """A connection that keeps what is sent over it, as a gimbal that turns by `signs` (position, speed) of its own."""

    def __init__(self, signs: tuple[int, int] = (1, 1)) -> None:
        self.messages: list[Message] = []
        self.position, self._signs = 0.0, signs

    def request(self, message: Message, _now: float) -> int:
        self.messages.append(message)
        if isinstance(message, gimbal.Position):
            self.position += self._signs[0] * message.yaw
        elif isinstance(message, gimbal.Speed):
            self.position += self._signs[1] * message.yaw * 0.05
        return 0

    def taken(self) -> list[bool]:
        """Of the speeds: whether each takes speed control over."""
        return [each.take_over for each in self.messages if isinstance(each, gimbal.Speed)]


def probe_on(sent: Sent, full: Callable[[Axis], float] | None = None) -> SignProbe:
    probe = SignProbe(cast(Connection, cast(Any, sent)), [PAN], WIRING, LIMITS, full)
    probe.start(0.0, {PAN: State(0.0)})
    return probe


def turn(probe: SignProbe, sent: Sent, until: Callable[[], bool]) -> float:
    for number in range(3000):
        now = number * PERIOD
        if until():
            return now
        probe.write(Tick(now, {PAN: State(0.0)}, {}, (), {PAN: Reading(sent.position, now)}))
    raise AssertionError("it never came to that")


@pytest.mark.parametrize(("position", "speed"), [(1, 1), (1, -1), (-1, 1), (-1, -1)])
def test_both_signs_are_found_and_the_axis_ends_where_it_began(position: int, speed: int):
    sent = Sent((position, speed))
    probe = probe_on(sent)
    turn(probe, sent, lambda: probe.done)
    assert (probe.signs[PAN].position, probe.signs[PAN].speed) == (position, speed)
    assert sent.position == pytest.approx(0.0, abs=0.1)
    assert sent.taken()[-1] is False


def test_a_gimbal_that_ignores_speeds_has_no_sign_of_them():
    sent = Sent((1, 0))
    probe = probe_on(sent)
    turn(probe, sent, lambda: probe.done)
    assert probe.signs[PAN].speed == 0


def test_an_axis_that_ignores_positions_is_an_error():
    sent = Sent((0, 1))
    probe = probe_on(sent)
    with pytest.raises(DeviceError, match="pan did not move by a position command"):
        turn(probe, sent, lambda: probe.done)


@pytest.mark.parametrize("place", [10 - 0.9 * ROOM, -10 + 0.9 * ROOM])
def test_an_axis_next_to_a_soft_limit_has_no_room(place: float):
    probe = SignProbe(cast(Connection, cast(Any, Sent())), [PAN], WIRING, LIMITS, None)
    with pytest.raises(DeviceError, match="pan has no room"):
        probe.start(0.0, {PAN: State(place)})


def test_an_axis_that_runs_away_ends_it():
    sent = Sent()
    probe = probe_on(sent)
    with pytest.raises(DeviceError, match=r"pan moved 1\.6 deg where 0\.5 were sent"):
        probe.write(Tick(0.0, {}, {}, (), {PAN: Reading(RUNAWAY + 0.1, 0.0)}))
    assert probe.done


def test_ended_while_it_cruises_it_sends_zeros_and_gives_speed_control_back():
    sent = Sent()
    probe = probe_on(sent)
    now = turn(probe, sent, lambda: probe.busy)
    sent.messages.clear()
    again: float | None = now
    while again is not None:
        again = probe.release(again)
    assert [each.yaw for each in sent.messages if isinstance(each, gimbal.Speed)] == [0.0] * (ZEROS + 1)
    assert sent.taken() == [True] * ZEROS + [False]
    assert probe.release(now + 1) is None
    assert len(sent.messages) == ZEROS + 1


def test_halted_during_a_position_move_it_holds_and_measures_the_axis_anew():
    sent = Sent()
    probe = probe_on(sent)
    now = turn(probe, sent, lambda: bool(sent.messages))
    probe.suspend(now)
    hold = sent.messages[-1]
    assert isinstance(hold, gimbal.Position)
    assert (hold.yaw, hold.roll, hold.pitch) == (0.0, 0.0, 0.0)
    count = len(sent.messages)
    probe.suspend(now)  # again: nothing more
    probe.write(Tick(now + 1, {PAN: State(0.0)}, {}, (), {PAN: Reading(sent.position, now + 1)}))
    assert len(sent.messages) == count
    probe.resume(0.0, {PAN: State(0.0)})
    turn(probe, sent, lambda: probe.done)
    assert probe.signs[PAN].position == 1
