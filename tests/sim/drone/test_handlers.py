"""What each message is answered by, and why it is not obeyed: docs/protocol-facts.md and OPENProtocol.md 3.1.9."""

from __future__ import annotations

from typing import Any

import pytest

from teleop.dji.drone import messages as drone
from teleop.dji.drone.enums import ArmCode, ArmOrder, Code, ControlCode, ControlOrder, TaskCode, TaskKind
from teleop.dji.drone.enums import TaskResultCode as ResultCode
from teleop.dji.drone.movement import Horizontal, Move, ReferenceFrame, Vertical, Yaw
from teleop.dji.drone.virtual_rc import Sticks, VirtualRc
from teleop.dji.message import Message, Opaque
from teleop.sim.drone.autopilot import Autopilot
from teleop.sim.drone.controls import Switch
from teleop.sim.drone.handlers import DroneHandlers
from teleop.sim.drone.settings import DroneSettings
from teleop.sim.drone.telemetry import TelemetrySender
from teleop.sim.refusals import Why

HOVER = Move(True, ReferenceFrame.BODY, Yaw.RATE, Vertical.VELOCITY, Horizontal.VELOCITY, 0, 0, 0, 0)


class Bench:
    """`refused` is what was refused, and why."""

    def __init__(self, activated: bool = True, **settings: Any) -> None:
        self.autopilot = Autopilot(0.0)
        self.refused: list[tuple[str, Why]] = []
        self.handlers = DroneHandlers(
            self.autopilot,
            TelemetrySender(False, 5),
            DroneSettings(**settings),
            lambda command, why, _detail: self.refused.append((command, why)),
        )
        if activated:
            self.handlers.answer(drone.Activate(1))

    def code(self, message: Message) -> object:
        """The code of the answer, None for no answer."""
        return getattr(self.handlers.answer(message), "code", None)

    def obtain(self) -> None:
        self.code(drone.Control(ControlOrder.OBTAIN))
        self.code(drone.Control(ControlOrder.OBTAIN))


def test_before_activation_only_the_version_is_told_and_streams_are_not_obeyed() -> None:
    bench = Bench(activated=False, broadcasts_before_activation=False)
    assert bench.code(drone.Version()) == Code.NOT_ACTIVATED
    assert bench.code(drone.Frequency()) == Code.NOT_ACTIVATED
    assert bench.code(drone.Task(TaskKind.LAND)) == TaskCode.NOT_ACTIVATED
    assert bench.handlers.answer(VirtualRc(on=True)) is None
    assert not bench.autopilot.virtual_on
    assert {why for _, why in bench.refused} == {Why.NOT_ACTIVATED}
    bench.code(drone.Activate(1))
    assert bench.code(drone.Version()) == Code.OK


def test_the_byte_of_a_version_request_may_be_any() -> None:
    bench = Bench()
    assert bench.code(Opaque(b"\0\0", b"\x7f")) == Code.OK
    assert bench.code(Opaque(b"\0\0", b"\0\0")) is None
    assert bench.refused == [("drone.version", Why.LENGTH)]


@pytest.mark.parametrize(
    ("message", "refused"),
    [
        (Opaque(b"\x01\x7f", b"\0"), ("0x017f", Why.UNKNOWN)),
        (Opaque(b"\x01\x03", b"\0"), ("drone.move", Why.LENGTH)),
        (drone.Task(99), ("drone.task", Why.RANGE)),
        (drone.GimbalSpeed(200, 0, 0), ("drone.gimbal_speed", Why.RANGE)),
        (drone.GimbalAngle(0, 0, 31, duration=1.0), ("drone.gimbal_angle", Why.RANGE)),
        (HOVER, ("drone.move", Why.NO_CONTROL)),
        (Sticks(), ("drone.sticks", Why.MODE)),
    ],
)
def test_what_is_not_obeyed_is_refused_with_its_reason(message: Message, refused: tuple[str, Why]) -> None:
    bench = Bench()
    bench.handlers.answer(message)
    assert bench.refused == [refused]


def test_each_order_of_control_is_confirmed_when_it_comes_again() -> None:
    bench = Bench()
    obtain, release = drone.Control(ControlOrder.OBTAIN), drone.Control(ControlOrder.RELEASE)
    assert [bench.code(obtain) for _ in range(3)] == [3, 2, 2]
    assert [bench.code(release) for _ in range(2)] == [4, 1]
    assert [bench.code(order) for order in (obtain, release, obtain)] == [3, 1, 3], "the other order comes between"


def test_control_is_given_in_f_mode_only() -> None:
    bench = Bench()
    bench.autopilot.turn_switch(Switch.P)
    assert bench.code(drone.Control(ControlOrder.OBTAIN)) == ControlCode.NOT_IN_F_MODE
    assert not bench.autopilot.obtained


def test_an_order_that_was_refused_begins_anew() -> None:
    bench = Bench()
    obtain = drone.Control(ControlOrder.OBTAIN)
    codes = []
    for switch in (Switch.F, Switch.P, Switch.F, Switch.F):
        bench.autopilot.turn_switch(switch)
        codes.append(bench.code(obtain))
    assert codes == [3, 0, 3, 2]


def test_arming_needs_control_and_motors_are_not_stopped_in_the_air() -> None:
    bench = Bench()
    arm, disarm = drone.Arm(ArmOrder.ARM), drone.Arm(ArmOrder.DISARM)
    assert bench.code(arm) == ArmCode.NEED_CONTROL
    bench.obtain()
    assert [bench.code(arm), bench.code(arm)] == [ArmCode.OK, ArmCode.ALREADY]
    bench.autopilot.flight.hover(5.0)
    assert bench.code(disarm) == ArmCode.IN_THE_AIR
    assert bench.autopilot.flight.motors


def test_a_task_needs_control_and_its_result_is_asked_for_by_its_number() -> None:
    bench = Bench()
    take_off = drone.Task(TaskKind.TAKE_OFF, number=7)
    assert bench.code(take_off) == TaskCode.FAILED
    bench.obtain()
    assert bench.code(take_off) == TaskCode.STARTED
    assert bench.code(drone.TaskResult(6)) == ResultCode.WRONG_NUMBER
    assert bench.code(drone.TaskResult(7)) == ResultCode.IN_PROGRESS
    bench.autopilot.pass_to(30.0)
    assert bench.code(drone.TaskResult(7)) == ResultCode.SUCCEEDED
    assert bench.code(take_off) == TaskCode.FAILED, "the motors run"


def test_virtual_rc_that_is_enabled_again_within_2_s_locks_the_drone() -> None:
    bench = Bench()
    bench.handlers.answer(VirtualRc(on=True))
    assert bench.refused == []
    bench.autopilot.pass_to(1.9)
    bench.handlers.answer(VirtualRc(on=True))
    assert bench.autopilot.locked
    bench.handlers.answer(VirtualRc(on=False))
    assert bench.refused == [("drone.virtual_rc", Why.STATE)] * 2


def test_photos_are_counted_and_a_video_runs_until_it_is_stopped() -> None:
    bench = Bench()
    for message in (drone.Photo(), drone.StartVideo(), drone.Photo()):
        assert bench.handlers.answer(message) is None
    assert (bench.handlers.payload.photos, bench.handlers.payload.recording) == (2, True)
    bench.handlers.answer(drone.StopVideo())
    assert not bench.handlers.payload.recording
