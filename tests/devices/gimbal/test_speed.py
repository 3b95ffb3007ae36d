"""Speed commands on the wire, and above all how speed control is given back."""

from typing import Any

import pytest
from far_end import FarEnd

from teleop.config.wiring import Wiring
from teleop.core.axes import Axis, Limits, Motion, Reading, State
from teleop.core.errors import LinkError
from teleop.core.events import Tick
from teleop.devices.gimbal.speed import BETWEEN_ZEROS, GIVE_BACKS, SETTLE, SETTLE_FRESH, SETTLE_WITHIN, ZEROS, SpeedSink
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.message import Message, Result

LIMITS = {
    Axis.PAN: Limits(-180, 180, 60, 120, 600),
    Axis.TILT: Limits(-56, 146, 60, 120, 600),
    Axis.ROLL: Limits(-30, 30, 60, 120, 600),
}


def sink_of(far: FarEnd, **wiring: int) -> SpeedSink:
    return SpeedSink(far.connection, 50, 0.0, Wiring(signs={Axis(axis): s for axis, s in wiring.items()}), LIMITS)


def tick(time: float, motion: Motion, measured: float | None = None, measured_at: float = 1.0) -> Tick:
    reported = {} if measured is None else {axis: Reading(measured, measured_at) for axis in motion}
    return Tick(time, motion, {}, (), reported)


def released(far: FarEnd, sink: SpeedSink, now: float) -> list[tuple[float, Any]]:
    """Every command of the release, and when it came; the gimbal answers."""
    far.replies.setdefault(gimbal.Speed, lambda _speed: Result(0))
    commands: list[tuple[float, Any]] = []
    due: float | None = now
    while due is not None:
        now, due = due, sink.release(due)
        commands += [(now, message) for message in far.serve(now)]
        far.connection.poll(now + 1e-3)
    return commands


def test_speeds_go_into_their_own_fields_in_the_profiles_signs() -> None:
    far = FarEnd()
    sink_of(far, tilt=-1).write(
        tick(1.0, {Axis.PAN: State(0, 10.0), Axis.TILT: State(0, 20.0), Axis.ROLL: State(0, 5.0)})
    )
    [command] = far.serve(1.0)
    assert isinstance(command, gimbal.Speed)
    assert (command.yaw, command.pitch, command.roll) == (10.0, -20.0, 5.0)
    assert command.take_over
    assert command.ignore_focal_length


def test_what_was_not_taken_over_is_not_given_back() -> None:
    far = FarEnd()
    assert sink_of(far).release(1.0) is None
    assert far.serve(1.0) == []


@pytest.mark.parametrize(
    ("measured", "measured_at", "settles"),
    [
        (5.0 + SETTLE_WITHIN / 2, 1.0, True),
        (5.0 + SETTLE_WITHIN * 2, 1.0, False),
        (5.0, 1.0 - SETTLE_FRESH * 2, False),
        (None, 1.0, False),
    ],
)
def test_release_is_zero_speed_then_giving_back_then_settling_where_it_is_near(
    measured: float | None, measured_at: float, settles: bool
) -> None:
    far = FarEnd()
    sink = sink_of(far)
    sink.write(tick(1.0, {Axis.PAN: State(5.0, 0.0)}, measured, measured_at))
    far.serve(1.0)
    commands = released(far, sink, 1.02)
    zeros, (given_back_at, given_back), *settling = commands[:ZEROS], commands[ZEROS], *commands[ZEROS + 1 :]
    assert [time for time, _ in zeros] == pytest.approx([1.02 + number * BETWEEN_ZEROS for number in range(ZEROS)])
    for _, zero in [*zeros, (given_back_at, given_back)]:
        assert isinstance(zero, gimbal.Speed)
        assert (zero.yaw, zero.roll, zero.pitch) == (0, 0, 0)
    assert [zero.take_over for _, zero in zeros if isinstance(zero, gimbal.Speed)] == [True] * ZEROS
    assert not given_back.take_over
    assert len(settling) == settles
    for _, command in settling:
        assert (command.yaw, command.time_for_action) == (5.0, SETTLE)
        assert (command.yaw_ignored, command.roll_ignored, command.pitch_ignored) == (False, True, True)
    assert sink.release(9.0) is None, "a second release has nothing to do"


@pytest.mark.parametrize("failing", range(ZEROS + 1))
def test_a_release_that_fails_on_the_way_can_be_tried_again(failing: int) -> None:
    far = FarEnd()
    sink = sink_of(far)
    sink.write(tick(1.0, {Axis.PAN: State(5.0, 30.0)}))
    far.serve(1.0)
    now = 1.02
    for _ in range(failing):
        now = sink.release(now) or now
    far.serve(now)
    send, far.here.send = far.here.send, refuse
    with pytest.raises(LinkError):
        sink.release(now)
    far.here.send = send
    commands = [command for _, command in released(far, sink, now + 0.01)]
    assert len(commands) == ZEROS + 1 - failing
    assert not commands[-1].take_over


@pytest.mark.parametrize(("lost", "given_back"), [(0, 1), (1, 2), (2, 3), (9, GIVE_BACKS)])
def test_giving_back_is_said_until_it_is_answered_but_not_for_ever(lost: int, given_back: int) -> None:
    far = FarEnd()
    sink = sink_of(far)
    sink.write(tick(1.0, {Axis.PAN: State(5.0, 0.0)}))
    far.serve(1.0)
    silence = iter(range(lost))

    def answer(speed: Message) -> Message | None:
        assert isinstance(speed, gimbal.Speed)
        return Result(0) if speed.take_over or next(silence, None) is None else None

    far.replies[gimbal.Speed] = answer
    commands = [message for _, message in released(far, sink, 1.02) if isinstance(message, gimbal.Speed)]
    assert [command.take_over for command in commands] == [True] * ZEROS + [False] * given_back


def refuse(data: bytes) -> None:
    raise LinkError("the bus is full")
