"""The `timelapse:` section of a sequence file, and what must hold in a file that has one.

In such a file the keyframes' times are output frames, from the first frame of the move on, because a timelapse is made
for its clip: how long the shoot takes follows from `interval`. Durations inside the section are real seconds.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from teleop.config.documents.base_model import Section
from teleop.config.documents.document import Location, Wrong, mapping, number, sequence
from teleop.config.documents.json_types import Interval, Settle, Time
from teleop.config.documents.messages import shown
from teleop.config.quantities import frame_rate, frames, seconds

MOST = 100_000  # frames: more than an hour of clip
UNUSED = {
    "cues": "the shutter is its only cue",
    "include": "an included move's times are seconds, not frames",
    "panorama": "it has frames of its own",
    "source": "its frames are seconds of a clip, not of a shoot",
    "repeat": "its frames are counted once",
    "preroll": "use delay",
    "back_to_one": "a shoot ends at its last frame",
    "fit": "use a longer interval",
}
Count = Annotated[int, Field(ge=0, le=MOST)]


class SettleSection(Section):
    """The gimbal counts as still when it is measured to turn slower than `below` (deg/s), or after `at_most`."""

    below: Annotated[float, Field(gt=0, le=100)]
    """Speed in deg/s below which the gimbal counts as still."""
    at_most: Any
    """Longest wait for that."""


class TimelapseSection(Section):
    """A timelapse, shot frame by frame. Its durations are real time."""

    RENAMED: ClassVar = {"camera_fault": "on_camera_fault"}

    frames: Annotated[int, Field(ge=1, le=MOST)]
    """Number of frames of the move."""
    interval: Interval
    """Time from one shutter to the next: `5s`, or `{from: 2s, to: 10s}` to grow evenly."""
    mode: Literal["shoot-move-shoot", "continuous"] = "shoot-move-shoot"
    """Rest while the camera exposes, or keep moving."""
    exposure: Time
    """Exposure time of the camera."""
    blur: Annotated[float, Field(ge=0, le=1)] = 0
    """Share of the way to the next frame that the camera moves on each side of mid exposure (go-motion)."""
    prefocus: Time = 0
    """Time for focusing before the shutter."""
    post: Time = 0
    """Time in which the camera needs rest after the exposure."""
    settle: Settle = 0.3
    """Time to come to rest: `0.3s`, or `{below: 0.1, at_most: 2s}` to measure it."""
    lead_in: Count = 0
    """Number of still frames before the move."""
    lead_out: Count = 0
    """Number of still frames after the move."""
    delay: Time = 0
    """Wait before the first frame."""
    on_camera_fault: Literal["stop", "continue"] = "stop"
    """When the camera refuses a command or does not answer: stop, or continue."""


def is_timelapse(data: Any) -> bool:
    """Whether a sequence file's keyframes are in output frames."""
    return "timelapse" in mapping(data)


def timelapse_rules(data: Any) -> Iterator[Wrong]:
    """Durations that are durations, keyframes within the frames that there are, nothing that only a film has."""
    for name, reason in UNUSED.items():
        if name in mapping(data):
            yield (name,), f"cannot be used with timelapse: {reason}"
    for where, ease in _eases(data):
        if isinstance(ease, str) and ease.strip()[-1:] in ("s", "m", "h") and ease[:1].isdigit():
            yield where, f"must be in output frames here (24f), or a share or a name, not {shown(ease)}"
    section, fps = mapping(data, "timelapse"), frame_rate(mapping(data).get("fps"))
    for name in ("exposure", "prefocus", "post", "delay"):
        yield from _duration(section, fps, name)
    yield from _blur_rules(section, fps)
    interval = section.get("interval")
    if isinstance(interval, Mapping):
        yield from _mapping_rules(section, fps, "interval", {"from": True, "to": True})
    else:
        yield from _duration(section, fps, "interval", positive=True)
    if isinstance(section.get("settle"), Mapping):
        yield from _mapping_rules(section, fps, "settle", {"below": None, "at_most": False})
    else:
        yield from _duration(section, fps, "settle")
    count = number(section.get("frames"))
    for index, frame in enumerate(sequence(data, "keyframes")):
        at = _frame(mapping(frame).get("at"))
        if at is not None and count is not None and 1 <= count <= at:
            last = f"{count - 1:g}, the last of {count:g} frames counted from 0"
            yield ("keyframes", index, "at"), f"must be at most {last}, not {at:g}"


def _blur_rules(section: Mapping[str, Any], fps: float | None) -> Iterator[Wrong]:
    if not number(section.get("blur")):
        return
    if section.get("mode") == "continuous":
        yield ("timelapse", "blur"), "cannot be used with mode: continuous: there the camera moves all the time"
    try:
        exposed = seconds(section.get("exposure"), fps)
    except ValueError:
        return
    if exposed == 0:
        yield ("timelapse", "exposure"), "must be more than 0 s with blur: the camera moves through the exposure"


def _eases(data: Any) -> Iterator[tuple[Location, Any]]:
    """Each ease that is written in the file, and where."""
    for path, section in [
        ((), data),
        *((("keyframes", i), each) for i, each in enumerate(sequence(data, "keyframes"))),
    ]:
        ease = mapping(section).get("ease")
        ends = ease if isinstance(ease, Mapping) else {None: ease}
        yield from (((*path, "ease", *([end] if end else [])), value) for end, value in ends.items())


def _mapping_rules(
    section: Mapping[str, Any], fps: float | None, name: str, known: Mapping[str, bool | None]
) -> Iterator[Wrong]:
    """A value that may also be a mapping: pydantic sees only that it may be anything.

    `known` says of each key whether it is a duration that must be positive (True), a duration (False), neither (None).
    """
    value = section[name]
    for key in value:
        if key not in known:
            yield ("timelapse", name, key), f": unknown key; the keys are {' and '.join(known)}"
    for key, positive in known.items():
        if key not in value:
            yield ("timelapse", name, key), "is missing"
        elif positive is not None:
            yield from _duration(value, fps, key, (name,), positive=positive)
        elif not 0 < (number(value[key]) or 0) <= 100:
            yield ("timelapse", name, key), f"must be a rate above 0 deg/s, not {shown(value[key])}"


def _duration(
    section: Mapping[str, Any], fps: float | None, key: str, below: tuple[str, ...] = (), *, positive: bool = False
) -> Iterator[Wrong]:
    if key not in section:
        return
    try:
        value = seconds(section[key], fps)
    except ValueError as error:
        yield ("timelapse", *below, key), str(error)
        return
    if positive and value == 0:
        yield ("timelapse", *below, key), "must be more than 0 s"


def _frame(value: Any) -> float | None:
    try:
        return frames(value)
    except ValueError:
        return None
