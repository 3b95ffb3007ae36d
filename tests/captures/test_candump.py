"""candump's log format: what is written is what python-can reads; what others write is read."""

from __future__ import annotations

import itertools
from pathlib import Path

import can
import pytest

from teleop.captures import candump
from teleop.captures.captured import Captured, CaptureError

FRAMES = [
    Captured(1732888888.123456, 0x222, bytes.fromhex("aa1a002000000000")),
    Captured(1732888888.123999, 0x223, b"\x01"),
    Captured(1732888888.2, 0x530, b""),
    Captured(1732888888.25, 0x18FF1234, b"\x02\x03", extended=True),
    Captured(1732888888.3, 0x222, b"", remote=True),
    Captured(1732888888.4, 0x0C0, bytes(8), error=True),
]


def parsed(text: str) -> list[Captured]:
    return [frame for _, frame in candump.frames(text.splitlines(keepends=True), "x.log")]


def test_lines_are_those_of_candump() -> None:
    assert [candump.line(frame, "can0") for frame in FRAMES] == [
        "(1732888888.123456) can0 222#AA1A002000000000\n",
        "(1732888888.123999) can0 223#01\n",
        "(1732888888.200000) can0 530#\n",
        "(1732888888.250000) can0 18FF1234#0203\n",
        "(1732888888.300000) can0 222#R\n",
        "(1732888888.400000) can0 200000C0#0000000000000000\n",
    ]


def test_python_can_reads_every_line(tmp_path: Path) -> None:
    file = tmp_path / "x.log"
    file.write_text("".join(candump.line(frame, "can0") for frame in FRAMES))
    with can.CanutilsLogReader(file) as reader:
        messages = list(reader)
    assert [message.channel for message in messages] == ["can0"] * 5 + [None]  # it gives error frames none
    for frame, message in zip(FRAMES[:5], messages, strict=False):
        assert message.timestamp == pytest.approx(frame.time, abs=1e-6)
        assert (message.arbitration_id, bytes(message.data)) == (frame.id, frame.data)
        assert (message.is_extended_id, message.is_remote_frame) == (frame.extended, frame.remote)
    assert messages[5].is_error_frame


def test_what_was_written_is_read_the_same() -> None:
    assert parsed("".join(candump.line(frame, "can0") for frame in FRAMES)) == FRAMES


@pytest.mark.parametrize(
    "line",
    [
        "(1.5) can0 222#AA1A R",
        "(1.5) vcan0 222#AA1A T",
        "(1.500000) can0 222#AA.1A",
        "(0000000001.500000)  can0  222   [2]  AA 1A",
        " (1.500000)  can0  222   [2]  AA 1A                     '..'",
        "(1.500000)  can0  RX - -  222   [2]  AA 1A",
        "(1.5) can0 222##0AA1A",
        "(1.5) can0 222#AA1A\r",
    ],
)
def test_lines_of_others(line: str) -> None:
    assert parsed(line + "\n") == [Captured(1.5, 0x222, b"\xaa\x1a")]


def test_a_date_is_a_time_too() -> None:
    early, late = parsed("(2024-11-29 14:01:28.250000) can0 222#\n(2024-11-29 14:01:29.750000) can0 222#\n")
    assert late.time - early.time == pytest.approx(1.5)


def test_what_is_no_candump_is_refused_with_its_line() -> None:
    with pytest.raises(CaptureError, match=r"^x\.log:2: no line of candump: 'hello'; write the file with candump -L$"):
        parsed("(1.5) can0 222#AA\nhello\n")


@pytest.mark.parametrize("cut", range(1, 24))
def test_a_last_line_that_was_cut_is_left_out(cut: int) -> None:
    whole = "(1.500000) can0 222#AA1A"
    text = f"(1.000000) can0 223#01\n{whole[:cut]}"
    found = parsed(text)
    assert found[0] == Captured(1.0, 0x223, b"\x01")
    assert all(whole.endswith("222#AA1A") and frame.data in (b"", b"\xaa") for frame in found[1:])


@pytest.mark.parametrize(
    ("channel", "name"),
    [
        ("can0", "can0"),
        ("/dev/ttyACM0", "ttyACM0"),
        ("0", "can0"),
        ("239.74.163.2", "239.74.163.2"),
        ("ff15:7079:7468:6f6e:6465:6d6f:6d63:6173", "ff15_7079_7468_"),
        ("a name", "a_name"),
    ],
)
def test_names_that_can_utils_takes(channel: str, name: str) -> None:
    assert candump.interface_name(channel) == name


def test_every_line_has_three_words_and_a_name_that_fits() -> None:
    for frame, channel in itertools.product(FRAMES, ("can0", "/dev/serial/by-id/usb-a very long name")):
        words = candump.line(frame, candump.interface_name(channel)).split()
        assert len(words) == 3
        assert len(words[1]) < 16
