"""Joystick pushes on the wire: scale, order, and the stick let go."""

from far_end import FarEnd
from hypothesis import given
from hypothesis import strategies as st

from teleop.config.wiring import Wiring
from teleop.core.axes import Axis, Limits, Motion, State
from teleop.core.events import Tick
from teleop.devices.gimbal.speed import BETWEEN_ZEROS, ZEROS
from teleop.devices.gimbal.stick import StickSink
from teleop.dji.gimbal import messages as gimbal

LIMITS = {axis: Limits(-180, 180, 40, 120, 600) for axis in (Axis.PAN, Axis.TILT, Axis.ROLL)}
FULL = {Axis.PAN: 60.0, Axis.TILT: 40.0, Axis.ROLL: 80.0}


def pushed(motion: Motion, wiring: Wiring | None = None) -> tuple[int, int, int]:
    """Pitch, roll, yaw."""
    far = FarEnd()
    StickSink(far.connection, 50, 0.0, wiring or Wiring(), LIMITS, FULL).write(Tick(1.0, motion, {}, (), {}))
    [push] = far.serve(1.0)
    assert isinstance(push, gimbal.Joystick)
    return push.pitch, push.roll, push.yaw


def test_a_speed_is_its_share_of_what_full_stick_gives() -> None:
    motion = {Axis.PAN: State(0, 30.0), Axis.TILT: State(0, -40.0), Axis.ROLL: State(0, 8.0)}
    assert pushed(motion) == (-15000, 1500, 7500)


def test_an_operators_pan_may_turn_the_roll() -> None:
    second = Wiring((None, Axis.PAN, Axis.TILT))
    assert pushed({Axis.PAN: State(0, 30.0), Axis.TILT: State(0, 20.0)}, second) == (7500, 7500, 0)


@given(st.floats(-500, 500))
def test_it_never_asks_for_more_than_the_axis_may_or_the_stick_can(velocity: float) -> None:
    _, _, yaw = pushed({Axis.PAN: State(0, velocity)})
    assert abs(yaw) <= 10000  # 40 of 60 deg/s


def test_the_stick_is_let_go_three_times_and_only_if_it_was_held() -> None:
    far = FarEnd()
    sink = StickSink(far.connection, 50, 0.0, Wiring(), LIMITS, FULL)
    assert sink.release(0.5) is None
    sink.write(Tick(1.0, {Axis.PAN: State(0, 30.0)}, {}, (), {}))
    far.serve(1.0)
    now, steps = 1.0, []
    while (due := sink.release(now)) is not None:
        steps.append(due - now)
        now = due
    assert [(push.pitch, push.roll, push.yaw) for push in far.serve(now) if isinstance(push, gimbal.Joystick)] == [
        (0, 0, 0)
    ] * ZEROS
    assert all(abs(step - BETWEEN_ZEROS) < 1e-9 for step in steps)
