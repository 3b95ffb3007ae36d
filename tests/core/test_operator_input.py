"""An input at one tick: what counts when two of them are compared."""

from __future__ import annotations

from dataclasses import replace

from teleop.core.axes import Axis
from teleop.core.operator_input import Command, Held, Press


def test_two_states_differ_by_what_moves_or_asks_for_something():
    held = Held({Axis.PAN: 0.5}, enabled=True)
    assert held == Held({Axis.PAN: 0.5}, enabled=True)
    for other in (
        {"deflections": {}},
        {"enabled": False},
        {"trouble": "unplugged"},
        {"presses": [Press(Command.STOP)]},
    ):
        assert held != replace(held, **other)


def test_the_worth_of_a_click_and_the_state_of_a_stop_make_no_difference():
    assert Held(stop="", click={Axis.PAN: 0.1}) == Held(stop="unplugged: gone", click={})


def test_an_input_without_an_enable_button_or_a_stop_is_told_from_one_that_has_them_off():
    held = Held()
    assert held.enabled is None
    assert held.stop is None
    assert held != replace(held, enabled=False)


def test_two_states_share_no_mapping():
    assert Held().deflections is not Held().deflections


def test_commands_are_the_words_of_profiles():
    assert Command("stop") is Command.STOP
    assert Press(Command("recall"), 3) == (Command.RECALL, 3, None, "")
