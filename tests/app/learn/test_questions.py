"""The questions of `live --learn`: every axis, every command, in words."""

from __future__ import annotations

from teleop.app.learn.questions import questions
from teleop.core.axes import Axis
from teleop.core.operator_input import Command


def test_every_axis_and_every_command_is_asked_for() -> None:
    asked = questions(Axis, dial=True, drone=True)
    assert {question.axis for question in asked if question.axis} == set(Axis)
    commands = {question.press for question in asked} | {question.hold for question in asked}
    assert commands - {None} == set(Command) - {Command.ENABLE}, "enable is a button to hold, and has its own question"
    assert [question.enable for question in asked].count(True) == 1
    assert [question.dial for question in asked].count(True) == 1


def test_they_are_asked_in_words() -> None:
    asked = questions([Axis.PAN, Axis.FOCUS])
    assert asked[0].text == "Move the control for PAN RIGHT"
    assert asked[1].back == "Move the control for FOCUS NEARER"
    assert asked[3].text == "Press the control for STOP"


def test_without_a_drone_or_a_gimbal_nothing_of_theirs_is_asked_for() -> None:
    asked = questions([Axis.FOCUS])
    assert not any(question.dial or question.command for question in asked)
    assert not {Command.ENGAGE, Command.DISENGAGE} & {question.press for question in asked}
