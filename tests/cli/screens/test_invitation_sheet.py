"""The address and QR code of the console over the screen of a run: when they show, and that 80 by 24 has room."""

from __future__ import annotations

import pytest
from rich.text import Text

from teleop.cli.screens.invitation_sheet import sheet
from teleop.cli.screens.picture import Rows
from teleop.console.invitation import invitation
from teleop.console.settings import ConsoleSettings, with_tokens
from teleop.core.invitation import Invitation
from teleop.inputs.keyboard import Keyboard
from teleop.inputs.keymaps import DRONE_WORDS, KeyReader
from teleop.inputs.playback_keymap import BY_HAND_KEYS, FLOWN_KEYS, KEYS, RUN_KEYS, TRIM_KEYS, PlayKeys

ROWS = Rows(
    Text("teleop live"), Text("STOPPED"), [Text(f"axis {n}") for n in range(5)], [Text("speed")], [Text("note")]
)
LAN = ConsoleSettings("192.168.100.100", 18470)


def drawn(settings: ConsoleSettings, wanted: bool = True, size: tuple[int, int] = (80, 24)) -> list[str]:
    reader = KeyReader()
    reader.inviting = wanted
    over = sheet(invitation(with_tokens(settings)), Keyboard(-1, reader))
    assert over is not None
    return [row.plain for row in over.over(ROWS, *size).fitted(*size)]


def test_it_shows_the_whole_code_and_the_address_under_a_stop_while_it_is_wanted() -> None:
    rows, code = drawn(LAN), invitation(with_tokens(LAN)).code
    assert "axis 0" in drawn(LAN, wanted=False)
    assert rows[:2] == ["teleop live", "STOPPED"]
    assert rows[2 : 2 + len(code)][0] == code[0]
    assert [row for row in rows if set(row) <= set("█▀▄ ") and row.strip()] == rows[2 : 2 + len(code)]
    assert rows[2 + len(code)].startswith(" Console: http://192.168.100.100:18470/login#")
    assert rows[-1] == " o back   space STOP"


def test_a_terminal_that_is_too_small_says_so_and_shows_the_address() -> None:
    rows = drawn(LAN, size=(80, 20))
    assert not any("█" in row for row in rows)
    assert any("The QR code needs a terminal of " in row for row in rows)
    assert any("http://192.168.100.100:18470/login#" in row for row in rows)


def test_an_address_for_this_computer_alone_has_no_code() -> None:
    rows = drawn(ConsoleSettings())
    assert " Console: http://127.0.0.1:8470/" in rows
    assert any("Only this computer can open it" in row for row in rows)
    assert sheet(None, Keyboard(-1)) is None
    assert sheet(Invitation([""]), None) is None


@pytest.mark.parametrize("keys", [None, KEYS, TRIM_KEYS, RUN_KEYS, FLOWN_KEYS, BY_HAND_KEYS])
def test_the_same_key_shows_and_hides_it_beside_every_run(keys: dict | None) -> None:
    reader = KeyReader() if keys is None else PlayKeys(keys)
    assert not list(reader.feed("o"))
    assert reader.inviting
    assert not list(reader.feed("o"))
    assert not reader.inviting
    list(reader.feed("o"))
    reader.settle()  # the escape key
    assert not reader.inviting


def test_a_letter_of_a_word_is_no_key() -> None:
    reader = KeyReader()
    assert list(reader.feed("dhome\n")) == [DRONE_WORDS["home"]]
    assert not reader.inviting
