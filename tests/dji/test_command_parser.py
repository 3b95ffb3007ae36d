"""What an operator types becomes a message, or an error that names what was wrong."""

from __future__ import annotations

from enum import IntEnum
from typing import Annotated

import pytest

from teleop.dji.command_parser import FieldHelp, Vocabulary, commands, fields_of, help_of, rows, spoken
from teleop.dji.fields import U8, Flag, Reserved
from teleop.dji.message import FieldError, Message, message


class Speed(IntEnum):
    UNCHANGED = 0
    VERY_SLOW = 1


@message("lamp.set_speed", 0x7E, 0x01)
class SetSpeed(Message):
    """A command that no device has."""

    speed: Annotated[int, U8(words=Speed)]
    loud: Annotated[bool, Flag(first=0)] = False
    reserved: Annotated[int, Reserved()] = 0


@message("lamp.set_speed", 0x7E, 0x01, reply=True)
class SetSpeedReply(Message):
    """Its reply, which nobody types."""


LAMP = Vocabulary(("lamp",), commands([SetSpeed, SetSpeedReply]), rows(Speed, "lamp", SetSpeed, "speed"))


@pytest.mark.parametrize("typed", ["lamp.set_speed", "LAMP set-speed", "  lamp   Set speed "])
def test_a_name_may_be_typed_in_any_case_with_spaces_underscores_or_hyphens(typed: str) -> None:
    assert spoken(typed) == "lamp set speed"


def test_a_reply_is_no_command_and_a_choice_that_changes_nothing_no_plain_word() -> None:
    assert LAMP.commands == {"lamp set speed": SetSpeed}
    assert LAMP.plain == {"lamp very slow": SetSpeed(Speed.VERY_SLOW)}


@pytest.mark.parametrize("words", [["very", "slow"], ["lamp", "very-slow"], ["set_speed", "speed=very_slow"]])
def test_the_device_may_be_left_out(words: list[str]) -> None:
    assert LAMP.find(words) == SetSpeed(Speed.VERY_SLOW)


def test_a_value_may_have_an_equals_sign() -> None:
    assert fields_of(["set", "a=b=c", "d="]) == {"a": "b=c", "d": ""}


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (["set", "speed", "speed=1", "speed=2"], "duplicate field"),
        (["very", "slow", "loud=true"], "very slow takes no fields"),
        (["very", "slwo"], "did you mean very slow?"),
        (["qqqq"], "unknown command qqqq$"),
        (["set", "speed"], "speed"),
    ],
)
def test_what_cannot_be_sent_is_an_error_that_says_why(words: list[str], error: str) -> None:
    with pytest.raises(FieldError, match=error.replace("?", r"\?")):
        LAMP.find(words)


def test_help_lists_what_an_operator_gives_with_its_default() -> None:
    speed, loud = help_of(SetSpeed)
    assert (speed.name, speed.default) == ("speed", None), "it has to be given"
    assert loud == FieldHelp("loud", loud.requirement, "false")
