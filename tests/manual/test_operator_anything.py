"""Any operator at all: inputs that come and go, deflect, press and fail at random, and what must hold all the same."""

from __future__ import annotations

import math
from collections.abc import Mapping

import pytest
from hands import Desk, FakeInput
from hypothesis import given, settings
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits, Motion
from teleop.core.events import DeviceCommand
from teleop.core.operator_input import Command
from teleop.core.setpoints import PositionTarget, Stop, VelocityTarget
from teleop.core.timing import PERIOD

WIDE = Limits(-40, 40, 120, 240, 1200)  # near enough to be run into
LIMITS = {Axis.PAN: WIDE, Axis.TILT: Limits(-math.inf, math.inf, 90, 180, 900), Axis.FOCUS: Limits(0, 1, 0.5, 2, 10)}
ROUNDED = 1 + 1e-6
EDGE = 1e-6  # units

DEFLECTIONS = st.sampled_from([0.0, 0.0, 0.0, 1.0, -1.0, 0.3, -0.02])
COMMANDS = st.sampled_from([command for command in Command if command is not Command.QUIT])
EVENTS = st.one_of(
    st.tuples(st.just("hold"), st.dictionaries(st.sampled_from(list(LIMITS)), DEFLECTIONS)),
    st.tuples(st.just("press"), COMMANDS),
    st.tuples(st.just("turn"), st.tuples(st.sampled_from(list(LIMITS)), st.floats(-50, 50))),
    st.tuples(st.just("trouble"), st.sampled_from(["", "", "it is gone"])),
    st.tuples(st.just("enabled"), st.booleans()),
    st.tuples(st.just("slide"), st.floats(0, 1)),
    st.tuples(st.just("dial"), DEFLECTIONS),
)
RUNS = st.lists(st.tuples(st.integers(0, 2), EVENTS, st.integers(1, 60)), min_size=1, max_size=40)


def happen(hand: FakeInput, kind: str, what: object) -> None:
    match kind:
        case "hold":
            assert isinstance(what, dict)
            hand.deflections = what
        case "press":
            assert isinstance(what, Command)
            hand.press(what, 1, DeviceCommand("gimbal", "follow lock"))
        case "turn":
            assert isinstance(what, tuple)
            hand.turn(*what)
        case "trouble":
            hand.trouble = str(what)
        case "enabled":
            hand.enabled = None if hand.enabled is None else bool(what)
        case "slide":
            assert isinstance(what, float)
            hand.positions = {Axis.FOCUS: what}
        case "dial":
            assert isinstance(what, float)
            hand.dial = what


def check_legal(before: Motion, after: Motion, limits: Mapping[Axis, Limits]) -> None:
    for axis, of in limits.items():
        position, velocity, acceleration = after[axis]
        assert of.minimum - EDGE <= position <= of.maximum + EDGE
        assert abs(velocity) <= of.velocity * ROUNDED
        assert abs(acceleration) <= of.acceleration * ROUNDED
        assert abs(acceleration - before[axis].acceleration) <= of.jerk * PERIOD * ROUNDED


class Witness:
    """Knows by itself, from what the hands held, which of them may move anything."""

    def __init__(self) -> None:
        self.armed = self.fresh = False

    def see(self, hand: FakeInput, reset: bool) -> None:
        if hand.trouble or reset:
            self.armed = self.fresh = False
            return
        self.armed = self.armed or not any(hand.deflections.values())
        self.fresh = self.armed and (self.fresh or hand.enabled is not True)

    def may_move(self, hand: FakeInput, hands_on: bool) -> bool:
        return self.armed and (hands_on if hand.enabled is None else bool(hand.enabled) and self.fresh)


@settings(max_examples=150)
@given(run=RUNS, ramp=st.sampled_from([0.0, 0.3, 2.0]), low_pass=st.sampled_from([0.0, 0.05, 1.0]))
def test_nothing_moves_without_a_trusted_hand(
    tmp_path_factory: pytest.TempPathFactory, run: list, ramp: float, low_pass: float
) -> None:
    hands = [FakeInput("first"), FakeInput("second", enabled=False), FakeInput("third")]
    file = tmp_path_factory.getbasetemp() / "unwritten" / "presets.yaml"
    desk = Desk(file, *hands, limits=LIMITS, ramp=ramp, low_pass=low_pass, start_range=3)
    desk.presets.store = lambda number, positions: None  # type: ignore[method-assign]  # the disk is another test's
    witnesses = [Witness() for _ in hands]
    stopped = False
    for index, (kind, what), ticks in run:
        happen(hands[index], kind, what)
        for number in range(ticks):
            pressed = what if kind == "press" and number == 0 else None
            before = desk.motion
            desk.tick()
            check_legal(before, desk.motion, LIMITS)
            resets = pressed in (Command.STOP, Command.ENABLE) or (pressed is Command.CLEAR and stopped)
            for hand, witness in zip(hands, witnesses, strict=True):
                enabling = pressed is Command.ENABLE and hand.enabled is not None
                witness.see(hand, resets and not enabling)
            stopped = pressed is Command.STOP or (stopped and pressed is not Command.CLEAR)
            assert desk.status.stopped == stopped
            check_demand(desk, hands, witnesses)
    for hand in hands:
        hand.trouble = "the cable was cut"
    desk.run(1.2)  # the fastest stop of pan takes 0.7 s
    assert desk.rests
    assert all(not math.isnan(state.position) for state in desk.motion.values())


def check_demand(desk: Desk, hands: list[FakeInput], witnesses: list[Witness]) -> None:
    if desk.status.stopped:
        assert desk.demand == {axis: Stop() for axis in LIMITS}
        return
    trusted = [
        hand
        for hand, witness in zip(hands, witnesses, strict=True)
        if witness.may_move(hand, desk.status.manual_control)
    ]
    for axis, wish in desk.demand.items():
        deflected = any(hand.deflections.get(axis) for hand in trusted)
        if isinstance(wish, PositionTarget):
            assert trusted
            assert not deflected
        assert isinstance(wish, VelocityTarget | PositionTarget)
    if not trusted:
        assert all(isinstance(wish, VelocityTarget) and wish.velocity == 0 for wish in desk.demand.values())
    moving = {axis for axis, state in desk.motion.items() if state.velocity}
    assert moving <= desk.demand.keys(), "what moves is told to, or is told to rest"
