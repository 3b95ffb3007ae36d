"""Times as people write them in a sequence: seconds, `1m30s`, frames, timecode. All become seconds, once, here.

In a timelapse the keyframes' times are output frames instead, and stay so until the interval is known."""

from __future__ import annotations

import math
import re
from typing import Any

from teleop.config.documents.messages import decimal_comma, shown
from teleop.config.frame_rates import drops, exact, exact_rate, frame_of, is_dropped, shown_rate, whole_rate

_PARTS = re.compile(r"(?:([0-9]+(?:\.[0-9]+)?)h)?(?:([0-9]+(?:\.[0-9]+)?)m)?(?:([0-9]+(?:\.[0-9]+)?)s)?")
_FRAMES = re.compile(r"([0-9]+)f")
_TIMECODE = re.compile(r"([0-9]+):([0-5][0-9]):([0-5][0-9])([:;])([0-9]+)")
LONGEST = 31 * 86400.0  # s
LONGEST_TEXT = 40  # characters: what is longer is no time, and a number of so many digits no number
_PERCENT = re.compile(r"([0-9]{1,6}(?:\.[0-9]{1,6})?)\s*%")
TIME_WRITTEN = rf"^\s*(?=\S)({_PARTS.pattern}|{_FRAMES.pattern}|{_TIMECODE.pattern})\s*$"
FRAMES_WRITTEN = rf"^\s*({_FRAMES.pattern})\s*$"
PERCENTAGE_WRITTEN = rf"^\s*({_PERCENT.pattern})\s*$"
"""What a schema calls a time, frames, a percentage."""

_WRITTEN = "4, 4s, 1m30s, 96f or 00:00:04:00"


def seconds(value: Any, fps: float | None) -> float:
    """`4`, `4s`, `1m30s`, `2h`, `96f` or `00:00:04:00` in seconds; the last two need `fps`, in frames per second.

    Timecode is non-drop, or with a semicolon (`00:01:00;02`) the drop-frame one of 29.97 and 59.94 fps. A rate of 29.97
    is 30000/1001, see `frame_rates`. Raises ValueError with what would be right.
    """
    time = _seconds(value, fps)
    if time > LONGEST:
        raise ValueError(f"must be at most {LONGEST / 86400:g} days, not {shown(value)}")
    return time


def _seconds(value: Any, fps: float | None) -> float:
    if isinstance(value, int | float) and not isinstance(value, bool):
        if not math.isfinite(value) or value < 0:
            raise ValueError(f"must be 0 s or later, not {value:g}")
        return float(value)
    text = value.strip() if isinstance(value, str) and len(value) <= LONGEST_TEXT else ""
    if text and (match := _PARTS.fullmatch(text)):
        hours, minutes, rest = (float(part or 0) for part in match.groups())
        return hours * 3600 + minutes * 60 + rest
    if match := _FRAMES.fullmatch(text):
        return float(int(match[1]) / exact(_needed(fps, text)))
    if match := _TIMECODE.fullmatch(text):
        hours, minutes, whole, mark, number = match.groups()
        return _timecode(text, (int(hours), int(minutes), int(whole), int(number)), _needed(fps, text), mark == ";")
    if comma := decimal_comma(value):
        raise ValueError(f": {comma}")
    raise ValueError(f"must be a time ({_WRITTEN}), not {shown(value)}")


def _timecode(text: str, label: tuple[int, int, int, int], fps: float, drop: bool) -> float:
    """Drop-frame timecode leaves out the first numbers of every minute but each tenth, to keep up with the clock."""
    _, minutes, whole, number = label
    if number >= whole_rate(fps):
        raise ValueError(f"has frame {number}, and there are {shown_rate(fps)} in a second")
    dropped = drops(fps) if drop else 0
    if drop and not dropped:
        raise ValueError(
            f"is {text}, in drop-frame timecode, which there is at 29.97 and 59.94 fps, not {shown_rate(fps)}"
        )
    if is_dropped(minutes, whole, number, dropped):
        upto = text[: max(text.rfind(";"), text.rfind(":")) + 1]
        raise ValueError(f"is {text}, a number that drop-frame timecode leaves out; {upto}{dropped:02} is the next")
    return float(frame_of(label, whole_rate(fps), dropped) / exact(fps))


def frames(value: Any) -> float:
    """`240` or `240f` as output frames of a timelapse. Raises ValueError with what would be right."""
    if isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value) and value >= 0:
        return float(value)
    if isinstance(value, str) and (match := _FRAMES.fullmatch(value.strip())):
        return float(match[1])
    raise ValueError(f"must be in output frames (240 or 240f), not {shown(value)}")


def frame_rate(given: Any) -> float | None:
    """What stands at `fps`, for rules that run beside pydantic; of a rate that is none, some rate: it has its error."""
    if given is None:
        return None
    usable = isinstance(given, int | float) and not isinstance(given, bool) and 0 < given <= 1000
    return exact_rate(float(given)) if usable else 24.0


def percentage(value: Any) -> float:
    """`30%` as 0.3. Raises ValueError with what would be right."""
    match = _PERCENT.fullmatch(value.strip()) if isinstance(value, str) else None
    if not match:
        raise ValueError(f"must be a percentage (30%), not {shown(value)}")
    return float(match[1]) / 100


def _needed(fps: float | None, text: str) -> float:
    if fps is None:
        raise ValueError(f"is {text}, in frames, which needs fps at the top of the file")
    return fps
