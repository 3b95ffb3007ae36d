"""Keys: every command has one, no sequence swallows a STOP, and whatever a terminal sends is survived."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.config.device_commands import parse_command
from teleop.core.axes import Axis
from teleop.core.events import DeviceCommand
from teleop.core.operator_input import Command, Press
from teleop.inputs import playback_keymap as play_keys
from teleop.inputs.keymaps import DRONE_WORDS, HELP, KEYS, PREFIXES, Act, JogStep, KeyReader


def typed(text: str) -> list[Act]:
    return list(KeyReader().feed(text))


def test_every_command_has_a_key() -> None:
    acts = [
        *KEYS.values(),
        *play_keys.KEYS.values(),
        *play_keys.TRIM_KEYS.values(),
        *DRONE_WORDS.values(),
        *(act for _, answers in PREFIXES.values() for act in answers.values()),
    ]
    assert {act.command for act in acts if isinstance(act, Press)} == set(Command)


def test_every_device_command_on_a_key_exists() -> None:
    presses = [act for act in (*PREFIXES["f"][1].values(), *DRONE_WORDS.values()) if isinstance(act, Press)]
    commands = [press.device_command for press in presses if press.command is Command.TELL]
    assert len(commands) > len(DRONE_WORDS) - 2
    for command in commands:
        assert parse_command(str(command)) == command


def test_the_help_fits_a_small_terminal() -> None:
    assert all(len(key) <= 8 and len(text) <= 42 for key, text in HELP)


@pytest.mark.parametrize(
    ("text", "acts"),
    [
        ("\x1b[C", [JogStep(Axis.PAN, 1)]),
        ("\x1bOD", [JogStep(Axis.PAN, -1)]),
        ("\x1b[1;2A", [JogStep(Axis.TILT, 10)]),
        ("\x1b[1;5B", [JogStep(Axis.TILT, -0.1)]),
        ("\x1b[1;3B", [JogStep(Axis.TILT, -1)]),
        ("\x1b[5~\x1b[15;2~", []),  # page up, F5 with shift
        ("lH", [JogStep(Axis.PAN, 0.1), JogStep(Axis.PAN, -10)]),
        ("[}", [JogStep(Axis.FOCUS, -0.01), JogStep(Axis.FOCUS, 0.1)]),
        ("3", [Press(Command.RECALL, 3)]),
        ("s3x4", [Press(Command.STORE, 3), Press(Command.DELETE, 4)]),
        ("fl", [Press(Command.TELL, device_command=DeviceCommand("gimbal", "follow lock"))]),
        ("fs", [Press(Command.TELL, device_command=DeviceCommand("gimbal", "follow sport"))]),
        ("tdoor,4.2\r", [Press(Command.TELL, device_command=DeviceCommand("target", "door,4.2"))]),
        ("tdoor \r", [Press(Command.STOP)]),  # the space bar is STOP there too
        ("tdoor\x1b[Aq", [JogStep(Axis.TILT, 1), Press(Command.QUIT)]),
        ("t\r3", [Press(Command.RECALL, 3)]),
        ("sq", []),  # taken back, and not a quit
        ("sx3", [Press(Command.DELETE, 3)]),
        ("s\x1b[C3", [JogStep(Axis.PAN, 1), Press(Command.RECALL, 3)]),
        ("s ", [Press(Command.STOP)]),
        ("\x1b ", [Press(Command.STOP)]),
        ("\x1b[ ", [Press(Command.STOP)]),
        ("\x1b[1;2 ", [Press(Command.STOP)]),
        ("\x1b\x1b[C", [JogStep(Axis.PAN, 1)]),
        ("wQ\n\t\xe9", []),
        ("dengage\n", [Press(Command.ENGAGE)]),
        ("dEngagr\x7fe\r3", [Press(Command.ENGAGE), Press(Command.RECALL, 3)]),
        ("dmode-a\n", [Press(Command.TELL, device_command=DeviceCommand("drone", "mode-a"))]),
        ("dq\nc", [Press(Command.CLEAR)]),  # no word, and neither a quit
        ("deng \n", [Press(Command.STOP)]),
        ("deng\x1b[C\n", [JogStep(Axis.PAN, 1)]),
        ("sdz", [Press(Command.RECENTER)]),  # the answer to another question begins no word
        ("b", [Press(Command.DISENGAGE)]),
    ],
)
def test_what_is_typed_is_what_is_asked_for(text: str, acts: list[Act]) -> None:
    assert typed(text) == [pytest.approx(act) if isinstance(act, float) else act for act in acts]


def test_a_question_is_shown_until_it_is_answered_or_taken_back() -> None:
    reader = KeyReader()
    list(reader.feed("s"))
    assert reader.question.startswith("store which preset?")
    list(reader.feed("5"))
    assert reader.question == ""
    list(reader.feed("f\x1b"))
    assert reader.is_waiting
    reader.settle()
    assert (reader.question, reader.is_waiting) == ("", False)


def test_a_sequence_cut_in_two_by_a_slow_line_is_one() -> None:
    reader = KeyReader()
    assert [act for piece in ("\x1b", "[", "1;", "2", "C") for act in reader.feed(piece)] == [JogStep(Axis.PAN, 10)]


@given(st.lists(st.sampled_from([*"s xfhl3[;1AC~?q", "\x1b", "\x1b[", "\xff"]), max_size=30))
def test_each_space_is_a_stop_however_it_comes(pieces: list[str]) -> None:
    reader = KeyReader()
    acts = [act for piece in pieces for act in reader.feed(piece)]
    assert acts.count(Press(Command.STOP)) == pieces.count(" ")


@given(st.binary(max_size=60))
def test_any_bytes_are_survived(data: bytes) -> None:
    assert typed(data.decode("latin-1")).count(Press(Command.STOP)) == data.count(b" ")
