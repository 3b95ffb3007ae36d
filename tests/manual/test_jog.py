"""Steps of keys, wheels and dials: a tap is made in full, a held key leads its axis by one step, and ends with it."""

from __future__ import annotations

from pathlib import Path

import pytest
from hands import Desk, FakeInput
from hypothesis import given, settings
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits, State
from teleop.core.operator_input import Command, Held
from teleop.core.run_status import stop_state
from teleop.inputs.keymaps import JogStep, KeyReader
from teleop.manual.jog import HELD_WITHIN
from teleop.manual.recall import at_rest

PAN = Axis.PAN
SLOW = {PAN: Limits(-180, 180, 5, 10, 50)}
FAST = {PAN: Limits(-180, 180, 120, 240, 1200)}
RIGHT, SHIFT_RIGHT, CTRL_RIGHT = "\x1b[C", "\x1b[1;2C", "\x1b[1;5C"


class Typing(FakeInput):
    """Keys as the terminal sends them, read as the keyboard reads them."""

    def __init__(self) -> None:
        super().__init__("keys")
        self._reader = KeyReader()

    def type(self, text: str) -> None:
        for act in self._reader.feed(text):
            if isinstance(act, JogStep):
                self.turn(act.axis, act.units)
                self.click[act.axis] = max(self.click.get(act.axis, 0.0), abs(act.units))
            else:
                self.press(act.command)

    def read(self, now: float) -> Held:
        held, self.click = super().read(now), {}
        return held


def desk_of(tmp_path: Path, limits: dict, start_range: int = 3) -> tuple[Desk, Typing]:
    keys = Typing()
    return Desk(tmp_path / "presets.yaml", keys, limits=limits, start_range=start_range), keys


def rest_of(state: State, limits: Limits) -> float:
    return at_rest(state, limits).position


@pytest.mark.parametrize("start_range", [1, 2, 3])
@pytest.mark.parametrize("limits", [FAST, SLOW])
@pytest.mark.parametrize(("key", "units"), [(RIGHT, 1.0), (SHIFT_RIGHT, 10.0), (CTRL_RIGHT, 0.1)])
def test_a_tap_moves_exactly_one_step_and_the_next_one_another(
    tmp_path: Path, key: str, units: float, limits: dict, start_range: int
) -> None:
    desk, keys = desk_of(tmp_path, limits, start_range)
    for taps in (1, 2, 3):
        keys.type(key)
        while not desk.demand or not desk.rests:
            desk.tick()
        desk.tick(2)
        assert desk.motion[PAN] == pytest.approx((taps * units, 0, 0), abs=1e-9)
        assert desk.demand == {}
    fastest = max(abs(motion[PAN].velocity) for motion in desk.history)
    assert fastest <= (0.1, 0.35, 1.0)[start_range - 1] * limits[PAN].velocity * (1 + 1e-6)


@pytest.mark.parametrize("start_range", [1, 2, 3])
@pytest.mark.parametrize("limits", [FAST, SLOW])
@pytest.mark.parametrize(("key", "units"), [(RIGHT, 1.0), (SHIFT_RIGHT, 10.0), (CTRL_RIGHT, 0.1)])
def test_fifteen_presses_in_half_a_second_lead_by_a_step_and_stop_with_the_key(
    tmp_path: Path, key: str, units: float, limits: dict, start_range: int
) -> None:
    desk, keys = desk_of(tmp_path, limits, start_range)
    of = limits[PAN]
    for _ in range(15):
        keys.type(key)
        desk.tick(3)
        desk.tick()
        assert desk.demand.keys() <= {PAN}
    released = desk.motion[PAN]
    furthest = max(rest_of(motion[PAN], of) for motion in desk.history[-4:])
    since = 0
    while not desk.rests:
        desk.tick()
        since += 1
        assert desk.motion[PAN].position <= furthest + units + 1e-6
    stopping = of.velocity / of.acceleration + of.acceleration / of.jerk
    assert since * 0.01 <= HELD_WITHIN + stopping + 0.1
    ahead = desk.motion[PAN].position - released.position
    assert ahead <= HELD_WITHIN * of.velocity + rest_of(State(0, of.velocity), of) + 1e-6
    there = desk.motion[PAN]
    desk.run(2)
    assert desk.motion[PAN] == there


def test_a_burst_in_one_tick_is_one_step_and_no_sum(tmp_path: Path) -> None:
    desk, keys = desk_of(tmp_path, FAST)
    keys.type(SHIFT_RIGHT * 15)
    desk.run(4)
    assert 0 < desk.motion[PAN].position <= 10


def test_a_held_key_goes_on_for_as_long_as_it_is_held_at_the_speed_of_its_range(tmp_path: Path) -> None:
    desk, keys = desk_of(tmp_path, FAST, start_range=2)
    for _ in range(60):
        keys.type(SHIFT_RIGHT)
        desk.tick(3)
    assert desk.velocity(PAN) == pytest.approx(0.35 * 120)
    keys.type("-")
    for _ in range(60):
        keys.type(SHIFT_RIGHT)
        desk.tick(3)
    assert desk.velocity(PAN) == pytest.approx(0.1 * 120)


def test_a_longer_step_is_made_in_full_though_a_shorter_one_follows_it(tmp_path: Path) -> None:
    desk, keys = desk_of(tmp_path, FAST)
    keys.type(SHIFT_RIGHT)
    desk.tick(20)
    keys.type(RIGHT)
    desk.run(3)
    assert 10 <= desk.motion[PAN].position <= 11


def test_there_and_back_are_two_steps(tmp_path: Path) -> None:
    desk, keys = desk_of(tmp_path, FAST)
    keys.type(SHIFT_RIGHT)
    desk.tick(30)
    keys.type("\x1b[1;2D")
    desk.run(3)
    assert desk.motion[PAN] == pytest.approx((0, 0, 0), abs=1e-9)


def test_a_stop_ends_a_held_key_and_what_was_typed_during_it_moves_nothing_afterwards(tmp_path: Path) -> None:
    desk, keys = desk_of(tmp_path, SLOW)
    for _ in range(30):
        keys.type(SHIFT_RIGHT)
        desk.tick(3)
    keys.type(" ")
    desk.tick()
    assert stop_state(desk.status.stopped, desk.motion) == "stopping"
    for _ in range(50):
        keys.type(SHIFT_RIGHT)
        desk.tick(3)
    assert desk.rests
    assert stop_state(desk.status.stopped, desk.motion) == "stopped"
    there = desk.motion[PAN]
    keys.type("c")
    desk.run(3)
    assert desk.motion[PAN] == there


@settings(max_examples=60, deadline=None)
@given(
    typed=st.lists(
        st.tuples(
            st.sampled_from([RIGHT, SHIFT_RIGHT, CTRL_RIGHT, "\x1b[D", "\x1b[1;2D", "-", "+"]), st.integers(1, 40)
        ),
        max_size=40,
    ),
    slow=st.booleans(),
)
def test_whatever_is_typed_no_axis_leads_by_more_than_a_step(
    tmp_path_factory: pytest.TempPathFactory, typed: list, slow: bool
) -> None:
    limits = SLOW if slow else FAST
    of, keys = limits[PAN], Typing()
    file = tmp_path_factory.getbasetemp() / "unwritten" / "presets.yaml"
    desk = Desk(file, keys, limits=limits, start_range=3)
    for text, ticks in typed:
        keys.type(text)
        desk.tick(ticks)
    rest = rest_of(desk.motion[PAN], of)
    while not desk.rests or desk.demand:
        desk.tick()
        assert abs(desk.motion[PAN].position - rest) <= 10 + 2 * abs(rest_of(State(0, of.velocity), of)) + 1e-6
    assert abs(desk.motion[PAN].position - rest) <= 10 + 1e-6


def test_a_wheel_leads_by_a_click(tmp_path: Path) -> None:
    wheel = FakeInput("dial")
    desk = Desk(tmp_path / "presets.yaml", wheel, limits=SLOW, start_range=3)
    for _ in range(50):
        wheel.turn(PAN, 4.0)  # four clicks of a degree
        wheel.click = {PAN: 1.0}
        desk.tick(2)
    released = desk.motion[PAN]
    desk.run(1.5)
    assert desk.rests
    assert desk.motion[PAN].position <= rest_of(released, SLOW[PAN]) + 1 + 1e-6


def test_a_slider_goes_where_it_is_at_the_axis_s_own_speed_and_a_stop_ends_it(tmp_path: Path) -> None:
    desk = Desk(tmp_path / "presets.yaml", limits=FAST, start_range=1)
    for share in (0.5, 0.6, 0.9):
        desk.pad.positions = {PAN: share}
        desk.tick(3)
    desk.run(1)
    assert desk.velocity(PAN) == pytest.approx(120)
    desk.press(Command.STOP)
    desk.run(2)
    there = desk.motion[PAN]
    desk.press(Command.CLEAR)
    desk.run(1)
    assert desk.motion[PAN] == there
