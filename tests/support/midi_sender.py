"""A sender of MIDI timecode, in mido's messages, at any rate, and the injected port that they come through."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import mido

from teleop.sequence.triggers.midi_timecode import DROP, RATES

WHOLE = (24, 25, 30, 30)  # frame numbers in a second


def label_of(count: int, rate: int) -> tuple[int, int, int, int]:
    """The label of the frame that so many come before: counted one by one where numbers are dropped."""
    per_minute = 60 * 30 - 2
    if rate == DROP:
        tens, rest = divmod(count, 10 * per_minute + 2)
        count += 18 * tens + (2 * ((rest - 2) // per_minute) if rest >= 2 else 0)
    seconds, frames = divmod(count, WHOLE[rate])
    return seconds // 3600 % 24, seconds // 60 % 60, seconds % 60, frames


def quarters(count: int, rate: int) -> Iterator[mido.Message]:
    """The eight quarter frames that spell one label."""
    hours, minutes, seconds, frames = label_of(count, rate)
    for piece, part in enumerate((frames, seconds, minutes, hours | rate << 5)):
        yield mido.Message("quarter_frame", frame_type=2 * piece, frame_value=part & 15)
        yield mido.Message("quarter_frame", frame_type=2 * piece + 1, frame_value=part >> 4)


def running(count: int, frames: int, rate: int, begin: float) -> Iterator[tuple[float, mido.Message]]:
    """Timecode from a frame on, for so many frames (even), with the time of each message."""
    for pair in range(0, frames, 2):
        for quarter, message in enumerate(quarters(count + pair, rate)):
            yield begin + (pair + quarter / 4) / RATES[rate], message


def full_frame(count: int, rate: int) -> mido.Message:
    hours, minutes, seconds, frames = label_of(count, rate)
    return mido.Message("sysex", data=[0x7F, 0x7F, 1, 1, hours | rate << 5, minutes, seconds, frames])


class Port:
    """Where a trigger listens; `play` hands over messages at their times, asking the trigger each tick between."""

    def __init__(self) -> None:
        self.now, self.name, self.closed = 0.0, "", False
        self._listener: Callable = lambda _message: None

    def opened(self, name: str, listener: Callable) -> Port:
        self.name, self._listener = name, listener
        return self

    def close(self) -> None:
        self.closed = True

    def play(self, messages, trigger, until: float) -> float | None:
        """When the trigger fired, on ticks of 10 ms; None if it has not by `until`."""
        coming = list(messages)
        tick = round(self.now * 100)
        while tick / 100 < until:
            tick += 1
            while coming and coming[0][0] <= tick / 100:
                self.now, message = coming.pop(0)
                self._listener(message)
            self.now = tick / 100
            if trigger.fired(self.now):
                return self.now
        return None
