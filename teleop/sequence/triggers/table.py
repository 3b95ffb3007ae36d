"""What may start a move that is in place: a key, the time of day, OSC over UDP, MIDI timecode.

A trigger is written as one word, its kind and then what it needs: `osc:9000/go`. Which class serves a kind is a row in
a table, so that one without its extra costs nothing. None of them starts anything by itself: the sequence asks, once
the rig is in place and as long as the run goes on, and what came before it asked does not count.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from datetime import datetime, timedelta

from teleop.core.clock import date
from teleop.core.errors import DeviceError, UsageError
from teleop.core.timing import PERIOD
from teleop.sequence.cycle import Trigger
from teleop.sequence.triggers.midi_timecode import Label

KINDS = "key, osc:9000/go, mtc, timecode:01:00:00:00 or time:18:30:00"
_TIME = re.compile(r"([01]?\d|2[0-3]):([0-5]\d)(?::([0-5]\d))?")
_TIMECODE = re.compile(r"([01]\d|2[0-3]):([0-5]\d):([0-5]\d)[:;]([0-2]\d)(?:@(.+))?")
_OSC = re.compile(r"(?:([^:/\s]+):)?(\d{1,5})(/\S*)")


class WrittenError(ValueError):
    """What stands after a trigger's kind is not what that needs; the text says what would be right."""


class KeyTrigger:
    """The operator's go, which any trigger obeys too, and nothing else."""

    again = True

    def open(self, stack: ExitStack) -> None: ...

    def arm(self, now: float) -> None: ...

    def fired(self, now: float) -> bool:  # noqa: ARG002 - the sequence hears the key itself
        return False

    def waits_for(self, now: float) -> str:  # noqa: ARG002 - nothing to count down
        return "enter"


class ClockTrigger:
    """The next `text` (18:30 or 18:30:00) of this computer's wall clock, which decides: set, it comes sooner or later.

    A time that a change to summer time leaves out comes an hour later, one that there is twice comes the first time.
    Raises WrittenError.
    """

    again = False

    def __init__(self, text: str, wall: Callable[[], float] = date) -> None:
        match = _TIME.fullmatch(text)
        if match is None:
            raise WrittenError("must be a time of day, as in time:18:30:00")
        hour, minute, second = (int(part or 0) for part in match.groups())
        self._wall = wall
        now = datetime.fromtimestamp(wall())
        at = now.replace(hour=hour, minute=minute, second=second, microsecond=0)
        if at.timestamp() <= now.timestamp():
            at = datetime.combine(now.date() + timedelta(days=1), at.time())
        self._at = at.timestamp()
        self._name = f"{at:%H:%M:%S}{'' if at.date() == now.date() else ' tomorrow'}"

    def open(self, stack: ExitStack) -> None: ...

    def arm(self, now: float) -> None:  # noqa: ARG002 - the wall clock decides
        late = self._wall() - self._at
        if late > PERIOD:
            raise DeviceError(f"{self._name} was {late:.1f} s before the rig reached the start")

    def fired(self, now: float) -> bool:  # noqa: ARG002
        return self._wall() >= self._at - PERIOD / 2

    def waits_for(self, now: float) -> str:  # noqa: ARG002
        left = max(0, round(self._at - self._wall()))
        parts = ((left // 3600, "h"), (left // 60 % 60, "min"), (left % 60, "s"))
        return f"{self._name}, in {' '.join(f'{count} {unit}' for count, unit in parts if count) or '0 s'}"


def read_trigger(text: str, now: Callable[[], float]) -> Trigger:
    """The trigger that is written so; `now` is the loop's clock. Raises UsageError with what would be right."""
    kind, _, rest = text.partition(":")
    try:
        if kind not in _BUILDERS:
            raise WrittenError(f"must be {KINDS}")
        return _BUILDERS[kind](rest, now)
    except WrittenError as error:
        raise UsageError(f"--trigger {text}: {error}") from None


def _key(rest: str, _now: Callable[[], float]) -> Trigger:
    if rest:
        raise WrittenError("must be just key: the Enter key")
    return KeyTrigger()


def _osc(rest: str, _now: Callable[[], float]) -> Trigger:
    match = _OSC.fullmatch(rest)
    if match is None or not 0 < int(match[2]) < 65536:
        raise WrittenError("must be a port and an address, as in osc:9000/go")
    from teleop.sequence.triggers.osc import OscTrigger

    return OscTrigger(match[1] or "127.0.0.1", int(match[2]), match[3])


def _mtc(rest: str, now: Callable[[], float]) -> Trigger:
    from teleop.sequence.triggers.midi import StartTrigger

    return StartTrigger(rest, now)


def _timecode(rest: str, now: Callable[[], float]) -> Trigger:
    match = _TIMECODE.fullmatch(rest)
    if match is None:
        raise WrittenError("must be a timecode, as in timecode:01:00:00:00")
    from teleop.sequence.triggers.midi import TimecodeTrigger

    return TimecodeTrigger(Label(*(int(part) for part in match.groups()[:4])), match[5] or "", now)


def _time(rest: str, _now: Callable[[], float]) -> Trigger:
    return ClockTrigger(rest)


_BUILDERS: Mapping[str, Callable[[str, Callable[[], float]], Trigger]] = {
    "key": _key,
    "osc": _osc,
    "mtc": _mtc,
    "timecode": _timecode,
    "time": _time,
}
