"""What can be made to go wrong with a simulated gimbal: reboot, a hand, angles that are not told, slow reactions."""

import pytest
from sim_bench import Bench

from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.enums import AngleKind

ANGLES = gimbal.Angles(AngleKind.ATTITUDE)
TURN = gimbal.Speed(30.0, 0.0, 10.0, take_over=True, ignore_focal_length=True)


def test_a_reboot_is_silence_and_then_a_gimbal_as_at_first() -> None:
    bench = Bench(boot=(5.0, 0.0, 0.0))
    bench.ask(gimbal.PushSettings(gimbal.Switch.ON))
    bench.ask(TURN)
    bench.wait(0.3)
    bench.gimbal.reboot(bench.now, 2.0)
    bench.unasked.clear()
    for _ in range(19):
        bench.wait(0.1)
        bench.tell(TURN)
        bench.tell(ANGLES)
    assert bench.listen() == bench.unasked == []
    assert bench.gimbal.rates == (0, 0, 0)
    assert not bench.gimbal.controlled
    bench.wait(0.2)
    reply = bench.ask(ANGLES)
    assert isinstance(reply, gimbal.AnglesReply)
    assert (reply.yaw, reply.roll, reply.pitch) == (5.0, 0.0, 0.0)
    bench.wait(1.0)
    assert bench.unasked == [], "the push has to be switched on again"


@pytest.mark.parametrize(
    "command",
    [
        TURN,
        gimbal.Position(40.0, 0.0, 20.0, absolute=True, time_for_action=0.5),
        gimbal.Joystick(15000, 0, 15000),
        gimbal.Mode(action=gimbal.CenterAction.RECENTER),
    ],
    ids=["speed", "position", "joystick", "recenter"],
)
def test_a_hand_holds_one_axis_and_lets_it_go_without_a_leap(command: gimbal.Message) -> None:
    bench = Bench(boot=(10.0, 0.0, 10.0))
    bench.gimbal.hold(bench.now, yaw=True)
    bench.tell(command)
    bench.wait(0.4)
    assert bench.gimbal.angles.yaw == 10.0
    assert abs(bench.gimbal.angles.pitch - 10.0) > 0.5
    bench.gimbal.hold(bench.now)
    bench.wait(0.4)
    assert bench.gimbal.angles.yaw == 10.0, "what it was told while it was held is forgotten"
    bench.tell(TURN)
    bench.wait(0.4)
    assert bench.gimbal.angles.yaw > 11.0


def test_a_touch_stops_an_axis_that_moves() -> None:
    bench = Bench()
    bench.tell(TURN)
    bench.wait(0.3)
    bench.gimbal.hold(bench.now, yaw=True)
    stood = bench.gimbal.angles.yaw
    bench.wait(0.1)
    assert bench.gimbal.angles.yaw == stood > 0
    assert bench.gimbal.rates.yaw == 0 < bench.gimbal.rates.pitch


def test_angles_may_be_kept_back_while_all_else_is_answered() -> None:
    bench = Bench()
    bench.ask(gimbal.PushSettings(gimbal.Switch.ON))
    bench.gimbal.tells_angles = False
    bench.tell(ANGLES)
    bench.wait(1.0)
    assert bench.unasked == []
    bench.ask(TURN)
    bench.gimbal.tells_angles = True
    assert isinstance(bench.ask(ANGLES), gimbal.AnglesReply)


def test_a_slow_reaction_is_the_same_motion_later() -> None:
    prompt, slow = Bench(), Bench(reaction=0.2)
    for bench in (prompt, slow):
        bench.ask(TURN)
    slow.wait(0.1)
    assert slow.gimbal.angles.yaw == 0.0
    assert not slow.gimbal.controlled
    prompt.wait(0.3)
    slow.wait(0.4)
    assert slow.gimbal.angles == pytest.approx(prompt.gimbal.angles, abs=1e-9)
    assert slow.gimbal.controlled
