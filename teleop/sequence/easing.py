"""Ease as people write it in a sequence: ramp seconds, a share of the way, or a name. All become a `Ramp`, here.

`ease: 1.5s` is both the arrival at a key and the departure from it; `ease: {arrive: 2s, leave: 25%}` tells them apart.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from teleop.config.documents.document import Wrong, mapping, sequence
from teleop.config.documents.messages import nearest, shown
from teleop.config.quantities import seconds
from teleop.core.axes import Axis
from teleop.planner.keyframes.ramp import LONGEST_SHARE, NAMES, SMOOTH, Ramp

Ramps = tuple[Ramp | None, Ramp | None]  # arrival and departure; None: as smooth as can be
ENDS = ("arrive", "leave")

_SHARE = re.compile(r"([0-9]+(?:\.[0-9]+)?)\s*%")
_WRITTEN = f"1.5s, 25%, {SMOOTH}, {' or '.join([', '.join([*NAMES][:-1]), [*NAMES][-1]])}"


def ramp(value: Any, fps: float | None) -> Ramp | None:
    """Seconds as `times.seconds` reads them, `25%` of the way from rest to rest, or a name; None for `smooth`.

    Raises ValueError with what would be right.
    """
    text = value.strip() if isinstance(value, str) else ""
    if text == SMOOTH:
        return None
    if text in NAMES:
        return NAMES[text]
    if match := _SHARE.fullmatch(text):
        share = float(match[1]) / 100
        if share > LONGEST_SHARE:
            raise ValueError(f"must be at most {LONGEST_SHARE:.0%} at each end of a move, not {text}")
        return Ramp(share=share)
    if text.isalpha():
        raise ValueError(f"must be {_WRITTEN}, not {text!r}{nearest(text, [SMOOTH, *NAMES])}")
    try:
        return Ramp(seconds=seconds(value, fps))
    except ValueError as error:
        wrong = str(error)
    raise ValueError(f"must be {_WRITTEN}, not {shown(value)}" if wrong.startswith("must be a time") else wrong)


def ramps(value: Any, fps: float | None, otherwise: Ramps = (None, None)) -> Ramps:
    """Both ends of what stands at `ease`; an end that is not named is that of `otherwise`. Raises ValueError."""
    if value is None:
        return otherwise
    if isinstance(value, Mapping):
        arrive, leave = (
            ramp(value[end], fps) if end in value else other for end, other in zip(ENDS, otherwise, strict=True)
        )
        return arrive, leave
    both = ramp(value, fps)
    return both, both


def ease_rules(data: Any, fps: float | None) -> Iterator[Wrong]:
    """Every `ease` can be read, and a keyframe that has one of its own is a rest of one of its axes."""
    if "ease" in mapping(data):
        yield from _wrong(("ease",), mapping(data)["ease"], fps)
    frames = [mapping(frame) for frame in sequence(data, "keyframes")]
    ends = {index for axis in Axis for named in [_naming(frames, axis)] if named for index in (named[0], named[-1])}
    based = [index for index, frame in enumerate(frames) if frame.get("base") is not None]
    ends |= {*based[:1], *based[-1:]}
    for index, frame in enumerate(frames):
        if "ease" in frame:
            yield from _wrong(("keyframes", index, "ease"), frame["ease"], fps)
            if index not in ends and frame.get("pass") != "stop" and "hold" not in frame:
                yield ("keyframes", index, "ease"), "needs a key to stop at: add pass: stop, or hold"


def _naming(frames: Sequence[Mapping[str, Any]], axis: Axis) -> Sequence[int]:
    aimed = axis in (Axis.PAN, Axis.TILT)
    return [
        index
        for index, frame in enumerate(frames)
        if frame.get(axis.value) is not None or (aimed and frame.get("aim") is not None)
    ]


def _wrong(where: tuple[str | int, ...], value: Any, fps: float | None) -> Iterator[Wrong]:
    ends = {(*where, key): end for key, end in value.items()} if isinstance(value, Mapping) else {where: value}
    for place, end in ends.items():
        if isinstance(value, Mapping) and place[-1] not in ENDS:
            yield place, f": unknown key; the keys are {' and '.join(ENDS)}"
            continue
        try:
            ramp(end, fps)
        except ValueError as error:
            yield place, str(error)
