"""Strange devices, made up here and played as recordings: no motion without a hand, no traceback, and a clear line."""

from __future__ import annotations

from pathlib import Path

import pytest
from played import (
    BUTTON,
    CONSTANT,
    CONSUMER,
    DIAL,
    GAMEPAD,
    HAT,
    JOYSTICK,
    KEYBOARD,
    MOUSE,
    NULL,
    RELATIVE,
    RX,
    RY,
    VENDOR,
    WHEEL,
    Player,
    Rows,
    X,
    Y,
    collection,
    held,
    inputs,
    padding,
    physical,
    report_id,
)

from teleop.core.axes import Axis

EIGHT = inputs(range(1, 9), 0, 1, 1, page=BUTTON)
STICK = inputs([X, Y], 0, 255, 8)
PAN = {Axis.PAN}


@pytest.fixture
def player(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Player:
    return Player(tmp_path, capsys)


def pushed(rest: bytes, right: bytes) -> Rows:
    """A second of rest, half a second of this, and rest."""
    return [*held(rest, 0, 1), *held(right, 1, 1.5), *held(rest, 1.5, 2)]


def beside(report: bytes, rows: Rows) -> Rows:
    """These, and this report behind each of them."""
    return [each for row in rows for each in (row, (row[0], report))]


def words(*numbers: int) -> bytes:
    return b"".join(number.to_bytes(4, "little", signed=True) for number in numbers)


MOUSE_PART = collection(
    MOUSE, inputs(range(1, 9), 0, 1, 1, page=BUTTON), inputs([X, Y], -127, 127, 8, RELATIVE), report=2
)
MEDIA = collection((CONSUMER, 1), inputs([0xE9], 0, 1, 8, page=CONSUMER), report=1)
TOUCHED = [
    pytest.param(
        collection(JOYSTICK, inputs([X, Y], 255, 0, 8), EIGHT),
        pushed(b"\x7f\x7f\0", b"\0\x7f\0"),
        id="a logical minimum above the maximum",
    ),
    pytest.param(
        collection(JOYSTICK, inputs([X, Y], -(2**31), 2**31 - 1, 32), EIGHT),
        pushed(words(0, 0) + b"\0", words(2**31 - 1, 0) + b"\0"),
        id="axes of 32 bits",
    ),
    pytest.param(
        collection(JOYSTICK, inputs([X, Y], 0, 2**32 - 1, 32), EIGHT),
        pushed(b"\0\0\0\x80" * 2 + b"\0", b"\xff" * 4 + b"\0\0\0\x80\0"),
        id="unsigned axes of 32 bits",
    ),
    pytest.param(
        collection(JOYSTICK, padding(8), STICK, padding(4), inputs([1], 0, 1, 1, page=BUTTON), padding(3), report=1)
        + collection(JOYSTICK, padding(64), report=5),
        [*pushed(b"\x01\xff\x7f\x7f\xf0", b"\x01\0\xff\x7f\xff"), *held(b"\x05" + b"\xff" * 8, 2, 3)],
        id="padding, and reports of nothing else",
    ),
    pytest.param(
        MEDIA + MOUSE_PART + collection(JOYSTICK, STICK, EIGHT, report=3),
        [
            *held(b"\x03\x7f\x7f\0", 0, 0.7),
            *held(b"\x02\0\x10\0", 0.7, 0.8),
            *held(b"\x01\x01", 0.8, 0.85),
            *pushed(b"\x03\x7f\x7f\0", b"\x03\xff\x7f\0")[85:],
            *held(b"\x02\0\x7f\x7f", 2, 2.1),
        ],
        id="a joystick behind a consumer control and a mouse",
    ),
    pytest.param(
        collection(GAMEPAD, STICK, EIGHT, report=1)
        + collection((VENDOR, 1), inputs([1], 0, 255, 8, page=VENDOR), report=9),
        beside(b"\x09\xff", pushed(b"\x01\x7f\x7f\0", b"\x01\xff\x7f\0")),
        id="a vendor's reports between the others",
    ),
    pytest.param(
        collection(JOYSTICK, physical(255, -255), STICK, EIGHT),
        pushed(b"\x7f\x7f\0", b"\xff\x7f\0"),
        id="a physical range the other way round",
    ),
    pytest.param(
        collection(JOYSTICK, STICK, EIGHT),
        [
            *pushed(b"\x7f\x7f\0", b"\xff\x7f\0\xaa\xaa\xaa\xaa"),
            *held(b"\x7f", 2, 2.5),
            *held(b"\x7f\x7f\0" + b"\xff" * 60, 2.5, 3),
        ],
        id="reports longer and shorter than described",
    ),
    pytest.param(
        collection(JOYSTICK, STICK, inputs([HAT, HAT], 1, 8, 4, NULL), EIGHT),
        [
            *pushed(b"\x7f\x7f\0\0", b"\xff\x7f\0\0"),
            *held(b"\x7f\x7f\x10\0", 2, 2.2),
            *held(b"\x7f\x7f\x01\0", 2.2, 2.4),
        ],
        id="two hats",
    ),
    pytest.param(
        collection(JOYSTICK, inputs([X, Y], -1, 1, 2), padding(4), EIGHT),
        pushed(b"\0\0", b"\x01\0"),
        id="a stick of two bits",
    ),
    pytest.param(
        collection(JOYSTICK, inputs([X, Y], 0, 254, 8, NULL), EIGHT),
        [*pushed(b"\x7f\x7f\0", b"\xfe\x7f\0"), *held(b"\xff\xff\0", 2, 3)],
        id="a stick with a null state",
    ),
    pytest.param(
        collection(JOYSTICK, inputs([RX, RY], -512, 511, 16), inputs([X, Y], 0, 255, 8), report=1)
        + collection(JOYSTICK, inputs([X, Y], 0, 255, 8), report=2),
        beside(b"\x02\0\xff", pushed(b"\x01\0\0\0\0\x7f\x7f", b"\x01\0\0\0\0\xff\x7f")),
        id="a second joystick held at its ends",
    ),
]


@pytest.mark.parametrize(("descriptor", "rows"), TOUCHED)
def test_a_strange_device_moves_what_a_hand_moves_and_nothing_else(
    player: Player, descriptor: bytes, rows: Rows
) -> None:
    played = player.play(player.device(descriptor, rows))
    assert played.moved == PAN
    assert played.at(Axis.PAN, 0.95) == 0, "nothing moves before the push"
    assert abs(played.at(Axis.PAN, 1.5)) > 0.1


NOTHING = "Strange pad cannot be used: it has no stick or button to guess a mapping for; teleop live --learn makes one"
MICE = [
    pytest.param(MOUSE_PART, held(b"\x02\0\x10\x10", 0, 1), MOUSE, id="a mouse"),
    pytest.param(MOUSE_PART, held(b"\x02\0\x10\x10", 0, 1), JOYSTICK, id="a mouse that the system lists as a joystick"),
    pytest.param(
        collection(KEYBOARD, inputs(range(0xE0, 0xE8), 0, 1, 1, page=7)),
        [*held(b"\0", 0, 0.5), *held(b"\xff", 0.5, 1)],
        KEYBOARD,
        id="a keyboard",
    ),
    pytest.param(
        collection((1, 0x0E), inputs([DIAL, WHEEL], -127, 127, 8, RELATIVE)) + MOUSE_PART,
        held(b"\x05\x05", 0, 1),
        (1, 0x0E),
        id="a wheel and a mouse",
    ),
]


@pytest.mark.parametrize(("descriptor", "rows", "usage"), MICE)
def test_nothing_is_guessed_for_what_is_no_stick(
    player: Player, descriptor: bytes, rows: Rows, usage: tuple[int, int]
) -> None:
    recording = player.device(descriptor, rows, usages=[list(usage)])
    played = player.play(recording, profile="inputs:\n  - device: {vendor: 0x1234, product: 0x5678}\n")
    assert not played.moved
    assert NOTHING in played.lines
    if usage != JOYSTICK:
        assert "no joystick was recorded: name the device" in player.refused(recording)


STILL = [
    pytest.param(inputs([X, Y], 0, 255, 8, CONSTANT), [(0x7F, 0x7F), (0xFF, 0x7F)], id="constant fields"),
    pytest.param(inputs([X, Y], 7, 7, 8), [(7, 7), (255, 7)], id="a range of one value"),
    pytest.param(inputs([X, Y], 0, 255, 8, RELATIVE), [(0, 0), (90, 0)], id="a stick that counts"),
]


@pytest.mark.parametrize(("part", "values"), STILL)
def test_what_says_nothing_of_a_place_moves_nothing(player: Player, part: bytes, values: list[tuple[int, int]]) -> None:
    rest, right = (bytes([*each, 0]) for each in values)
    assert not player.play(player.device(collection(JOYSTICK, part, EIGHT), pushed(rest, right))).moved


def test_a_stick_whose_reports_end_while_others_go_on_is_no_longer_believed(player: Player) -> None:
    descriptor = collection(JOYSTICK, STICK, report_id(2), EIGHT, report=1)
    both = beside(b"\x02\0", held(b"\x01\x7f\x7f", 0, 1))
    buttons = [(time, bytes([2, index % 2 << 7])) for index, (time, _) in enumerate(held(b"", 1.5, 5))]
    played = player.play(player.device(descriptor, [*both, *held(b"\x01\xc0\x7f", 1, 1.5), *buttons]))
    assert played.at(Axis.PAN, 1.5) > 0.1
    assert played.at(Axis.PAN, 2.5) == played.last(Axis.PAN), "a report that ended is no hand"
