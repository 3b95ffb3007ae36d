"""A drone's sticks in an operator's hands: where the hand's stick is, for as long as somebody holds it."""

from __future__ import annotations

from pathlib import Path

import pytest
from fakes import NO_FEEDBACK
from hands import LIMITS, Desk

from teleop.core.axes import STICKS, Axis, Limits
from teleop.core.events import DeviceCommand
from teleop.core.operator_input import Command
from teleop.core.setpoints import PositionTarget, Stop
from teleop.inputs.recorded_sticks import Sticks, SticksSource

ALL = {**LIMITS, **{axis: Limits(-1, 1, 4, 20, 200) for axis in STICKS}}
PITCH = Axis.STICK_PITCH


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    desk = Desk(tmp_path / "presets.yaml", limits=ALL, ramp=0, low_pass=0)
    desk.pad.hold(pan=0.0, stick_pitch=0.0)
    desk.tick()
    return desk


def test_a_deflection_is_a_position_whatever_the_speed_range(desk: Desk) -> None:
    assert desk.demand == {PITCH: PositionTarget(0.0)}, "centred, and somebody is there"
    desk.pad.hold(pan=0.0, stick_pitch=0.5)
    desk.run(1)
    assert desk.demand == {PITCH: PositionTarget(0.5)}
    assert desk.motion[PITCH] == (pytest.approx(0.5), 0, 0)
    desk.pad.hold(pan=0.0, stick_pitch=0.0)
    desk.run(1)
    assert desk.motion[PITCH].position == pytest.approx(0)


def test_without_a_hand_nothing_is_said_of_it_and_it_springs_back(desk: Desk) -> None:
    desk.pad.hold(pan=0.0, stick_pitch=1.0)
    desk.run(1)
    desk.pad.trouble = "pad: silent for 0.2 s"
    desk.tick()
    assert PITCH not in desk.demand
    desk.run(1)
    assert desk.motion[PITCH] == (pytest.approx(0), 0, 0)
    desk.pad.trouble = ""
    desk.run(0.5)
    assert PITCH not in desk.demand, "held over while nobody listened"
    desk.pad.hold(pan=0.0, stick_pitch=0.0)
    desk.run(0.1)
    desk.pad.hold(pan=0.0, stick_pitch=0.3)
    desk.tick()
    assert desk.demand[PITCH] == PositionTarget(0.3)


def test_the_e_stop_halts_it_in_its_centre_and_forbids_engaging(desk: Desk) -> None:
    desk.pad.hold(pan=0.0, stick_pitch=1.0)
    desk.run(1)
    desk.press(Command.STOP)
    assert desk.demand[PITCH] == Stop()
    desk.run(1)
    assert desk.motion[PITCH].position == pytest.approx(0)
    desk.press(Command.ENGAGE)
    assert desk.messages[0] == "drone: not engaged: STOP is not cleared"
    desk.press(Command.DISENGAGE)
    assert desk.actions == [DeviceCommand("drone", "disengage")]


def test_presets_leave_it_alone_and_it_leaves_presets_alone(desk: Desk) -> None:
    desk.pad.hold(pan=0.0, stick_pitch=0.5)
    desk.run(1)
    desk.press(Command.STORE, 1)
    preset = desk.presets.get(1)
    assert preset is not None
    assert PITCH not in preset.positions
    desk.pad.hold(pan=1.0, stick_pitch=0.5)
    desk.run(1)
    desk.pad.hold(pan=0.0, stick_pitch=0.5)
    desk.run(1)
    desk.press(Command.RECALL, 1)
    desk.run(0.2)
    assert desk.status.recall == "preset 1", "flying on does not end it"
    assert desk.demand[PITCH] == PositionTarget(0.5)


def test_no_step_moves_it(desk: Desk) -> None:
    desk.pad.turn(PITCH, 0.3)
    desk.run(0.5)
    assert desk.motion[PITCH].position == 0
    assert "stick_pitch moves only while a stick is held" in desk.messages


def test_what_a_drone_is_told_does_not_wait_for_rest(desk: Desk) -> None:
    desk.pad.hold(pan=1.0, stick_pitch=0.5)
    desk.run(0.5)
    desk.press(Command.ENGAGE)
    desk.press(Command.TELL, device_command=DeviceCommand("drone", "arm"))
    assert desk.actions == [DeviceCommand("drone", "engage"), DeviceCommand("drone", "arm")]


def test_recorded_sticks_hold_it_where_the_row_has_it_to_the_end() -> None:
    source = SticksSource(Sticks([PITCH, Axis.PAN], [0, 1, 2], [[0, 0], [0.5, 0.5], [0, 0]]), lambda _axis, d: 10 * d)
    source.start(5.0, {})
    assert source.read(5.5, NO_FEEDBACK)[0] == {PITCH: PositionTarget(0)}
    assert source.read(6.5, NO_FEEDBACK)[0][PITCH] == PositionTarget(0.5)
    assert source.read(7.0, NO_FEEDBACK)[0] == {PITCH: PositionTarget(0.0)}, "let go, and still held"
