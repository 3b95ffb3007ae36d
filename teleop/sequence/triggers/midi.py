"""Starts by MIDI timecode: when it begins to run, or when it comes to a given time.

The port's thread only notes what has come, and when; it is understood in the control thread. A timecode is known two
frames after it has begun, so a move that starts with it does so then, and one that starts at a time of it to the tick.
"""

from __future__ import annotations

import math
import os
import sys
from collections import deque
from collections.abc import Callable
from contextlib import ExitStack
from typing import Any

from teleop.core.errors import DeviceError, UsageError
from teleop.core.timing import PERIOD
from teleop.links.midi_ports import SEQUENCER
from teleop.sequence.triggers.midi_timecode import RATES, Label, MidiTimecode

LATE = 0.5  # s: a timecode further past the time than that has not come to it, but jumped over it

Listener = Callable[[Any], object]
OpenPort = Callable[[str, Listener], Any]  # a port by its name, "" for the only one; it has `close`


def open_port(name: str, listener: Listener) -> Any:
    """A MIDI input of this computer, whose messages go to `listener`.

    Raises UsageError without the extra, or for a name that there is not, DeviceError where there is no MIDI.
    """
    try:
        import mido
        import rtmidi  # noqa: F401 - mido finds it when it is needed, and says little where it is missing
    except ImportError:
        raise UsageError(
            "--trigger: MIDI timecode needs mido and python-rtmidi: pip install 'rs-teleop[midi]'"
        ) from None
    if sys.platform == "linux" and not os.path.exists(SEQUENCER):
        raise DeviceError(f"--trigger: this computer has no MIDI ({SEQUENCER} is missing): sudo modprobe snd-seq")
    try:
        names = mido.get_input_names()  # type: ignore[attr-defined] - made by mido when its backend is loaded
        found = [each for each in names if name in each]
        if len(found) != 1:
            there = f"there are {', '.join(names)}" if names else "there is none"
            raise UsageError(
                f"--trigger: which MIDI input? Write mtc:NAME or timecode:...@NAME, a part of its name; {there}"
            )
        return mido.open_input(found[0], callback=listener)  # type: ignore[attr-defined]
    except OSError as error:
        raise DeviceError(f"--trigger: no MIDI: {error}") from None


class _MidiTrigger:
    again = True

    def __init__(self, port: str, now: Callable[[], float], opener: OpenPort = open_port) -> None:
        self._port, self._now, self._opener = port, now, opener
        self._heard: deque[tuple[float, Any]] = deque()
        self.timecode = MidiTimecode()
        self._armed_at = 0  # the number of the first quarter frame that counts

    def open(self, stack: ExitStack) -> None:
        stack.callback(self._opener(self._port, lambda message: self._heard.append((self._now(), message))).close)

    def _listen(self) -> None:
        """Understand what has come since the last time."""
        while self._heard:
            time, message = self._heard.popleft()
            if message.type == "quarter_frame":
                self.timecode.quarter(message.frame_type, message.frame_value, time)
            elif message.type == "sysex":
                self.timecode.full(tuple(message.data), time)

    def _arm(self) -> None:
        """What came before does not count, a beginning of which only the end comes now included."""
        self._listen()
        self._armed_at = self.timecode.quarters


class StartTrigger(_MidiTrigger):
    """Fires when timecode begins to run; one that runs already has to stop first."""

    def arm(self, now: float) -> None:  # noqa: ARG002
        self._arm()
        self._starts = self.timecode.starts

    def fired(self, now: float) -> bool:
        self._listen()
        began = self.timecode.starts > self._starts and self.timecode.run_from >= self._armed_at
        return began and self.timecode.runs(now)

    def waits_for(self, now: float) -> str:
        return "MIDI timecode to stop and start again" if self.timecode.runs(now) else "MIDI timecode to start"


class TimecodeTrigger(_MidiTrigger):
    """Fires when running timecode comes to `label`, or begins there; not when it jumps over it."""

    def __init__(self, label: Label, port: str, now: Callable[[], float], opener: OpenPort = open_port) -> None:
        super().__init__(port, now, opener)
        self._label = label
        self._before = False  # it has been seen before the label, or there

    def arm(self, now: float) -> None:
        self._arm()
        self._jumps = self.timecode.jumps
        self._before = self._label.time(self.timecode.rate) >= self.timecode.position(now)

    def fired(self, now: float) -> bool:
        self._listen()
        timecode, target = self.timecode, self._label.time(self.timecode.rate)
        left = target - timecode.position(now)
        if timecode.jumps != self._jumps:  # it began, or jumped
            self._jumps = timecode.jumps
            here = abs(timecode.began - target) < 1 / RATES[timecode.rate]
            self._before = here and timecode.jumped_from >= self._armed_at
        if left > PERIOD / 2 or (left == 0 and not timecode.runs(now)):
            self._before = True
            return False
        return timecode.runs(now) and self._before and left > -LATE

    def waits_for(self, now: float) -> str:
        position = self.timecode.position(now)
        if math.isnan(position):
            return f"timecode {self._label}; none received yet"
        left = self._label.time(self.timecode.rate) - position
        where = f"{left:.1f} s to go" if left > 0 else "already past"
        return f"timecode {self._label}; {where}{'' if self.timecode.runs(now) else ', stopped'}"
