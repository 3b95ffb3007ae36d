"""What may start a move that is in place: a key, the time of day, OSC over UDP, MIDI timecode.

A trigger is written as one word, its kind and then what it needs: `osc:9000/go`. Which class serves a kind is a row in
a table, so that one without its extra costs nothing. None of them starts anything by itself: the sequence asks, once
the rig is in place and as long as the run goes on, and what came before it asked does not count.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from contextlib import ExitStack

from teleop.core.errors import UsageError
from teleop.sequence.cycle import Trigger
from teleop.sequence.triggers.midi_timecode import Label
from teleop.sequence.triggers.time_of_day import ClockTrigger
from teleop.sequence.triggers.written import WrittenError

KINDS = "key, osc:9000/go, mtc, timecode:01:00:00:00 or time:18:30:00"
_TIMECODE = re.compile(r"([01]\d|2[0-3]):([0-5]\d):([0-5]\d)[:;]([0-2]\d)(?:@(.+))?")
_OSC = re.compile(r"(?:([^:/\s]+):)?(\d{1,5})(/\S*)")


class KeyTrigger:
    """The operator's go, which any trigger obeys too, and nothing else."""

    again = True

    def open(self, stack: ExitStack) -> None: ...

    def arm(self, now: float) -> None: ...

    def fired(self, now: float) -> bool:  # noqa: ARG002 - the sequence hears the key itself
        return False

    def waits_for(self, now: float) -> str:  # noqa: ARG002 - nothing to count down
        return "enter"


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


def _time(rest: str, now: Callable[[], float]) -> Trigger:
    return ClockTrigger(rest, now=now)


_BUILDERS: Mapping[str, Callable[[str, Callable[[], float]], Trigger]] = {
    "key": _key,
    "osc": _osc,
    "mtc": _mtc,
    "timecode": _timecode,
    "time": _time,
}
