"""MIDI messages as bytes: what a control sends, and what lights and motor faders get. Pure; anything may come in."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from teleop.config.exchange.midi import Control

NOTE_OFF, NOTE_ON, CC, BEND = 0x80, 0x90, 0xB0, 0xE0
ACTIVE_SENSING = 0xFE
LOWER = 32  # the controller with a fader's lower 7 bits is that far above the one with its upper bits
COARSE, FINE = 127, 16383


class Moved(NamedTuple):
    """A control has sent `value`, of 127 (`kind` note or cc) or of 16383 (bend)."""

    control: Control
    value: int


def read(data: Sequence[int]) -> Moved | None:
    """What a message says; None for one that is no control's, or no message."""
    if len(data) != 3 or not 0x80 <= data[0] < 0xF0 or data[1] > 127 or data[2] > 127:
        return None
    kind, channel = data[0] & 0xF0, data[0] & 0x0F
    match kind:
        case 0x80:
            return Moved(Control("note", data[1], channel), 0)
        case 0x90:
            return Moved(Control("note", data[1], channel), data[2])
        case 0xB0:
            return Moved(Control("cc", data[1], channel), data[2])
        case 0xE0:
            return Moved(Control("bend", 0, channel), data[1] | data[2] << 7)
        case _:
            return None


def light(control: Control, on: bool) -> tuple[int, int, int]:
    """What lights a button, or puts its light out."""
    if control.kind == "note":
        return (NOTE_ON if on else NOTE_OFF) | control.channel, control.number, COARSE if on else 0
    return CC | control.channel, control.number, COARSE if on else 0


def motor(control: Control, share: float) -> list[tuple[int, int, int]]:
    """What sends a motor fader to a share (0..1) of its way."""
    share = min(max(share, 0.0), 1.0)
    if control.kind == "cc":
        return [(CC | control.channel, control.number, round(share * COARSE))]
    value = round(share * FINE)
    if control.kind == "bend":
        return [(BEND | control.channel, value & 127, value >> 7)]
    upper, lower = (CC | control.channel, control.number), (CC | control.channel, control.number + LOWER)
    return [(*upper, value >> 7), (*lower, value & 127)]


def clicks(value: int, way: str) -> int:
    """How many clicks a wheel without ends was turned, + to the right."""
    match way:
        case "twos":
            return value if value < 64 else value - 128
        case "sign":
            return value if value < 64 else 64 - value
        case _:
            return value - 64
