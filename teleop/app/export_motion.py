"""A move or a take as a file of another program: its path by the frame, and one line for each thing left behind."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from teleop.app.planning import Plan
from teleop.config.documents.document import DocumentError, UnplayableError
from teleop.config.frame_rates import exact
from teleop.core.axes import Axis
from teleop.core.events import Action, DeviceCommand
from teleop.core.timing import SAME_TIME
from teleop.interchange import companion
from teleop.interchange.motion import Motion, TimedCue
from teleop.interchange.table import Format, WriteOptions
from teleop.planner.polynomial import Array
from teleop.recording.passes import passes
from teleop.recording.reader import Take
from teleop.sequence.cues import FOLLOW

USUAL_RATE = Fraction(24)
"""Frames a second where neither the move nor the user says: what is written says it, so it is a choice, not a guess."""
MOST_ROWS = 5_000_000


@dataclass(frozen=True)
class Exported:
    """The bytes of a file, the text of the one beside it (None: it needs none), and lines for the user."""

    content: bytes
    beside: str | None
    not_carried: Sequence[str]
    motion: Motion


def own_rate(plan: Plan) -> Fraction | None:
    """The frames a second that the file of a move gives, of a timelapse those of its clip."""
    fps = plan.sequence.fps if plan.timelapse is None else plan.timelapse.fps
    return exact(fps) if fps else None


def planned_motion(plan: Plan, origin: str, rate: Fraction | None, first: int = 1) -> Motion:
    """The planned path at every frame, the last ones where all has come to rest; a timelapse by its output frames."""
    sequence = plan.sequence
    rate = rate or own_rate(plan) or USUAL_RATE
    if plan.timelapse is not None:
        count = plan.timelapse.frames
        positions: Mapping[Axis, Array] = plan.timelapse.path.positions(count)
    else:
        count = math.ceil(sequence.move.duration * rate - 1e-6) + 1
        count += sequence.move.duration > 0  # two frames alike say that it has come to rest
        _check_rows(count, origin)
        times = np.arange(count) / float(rate)
        positions = {axis: rows[0] for axis, rows in sequence.move.sample(times).items()}
    times = np.arange(count) / float(rate)
    cues = [TimedCue(cue.at, _content(cue.action)) for cue in sequence.cues]
    return Motion(sequence.title, times, positions, rate, first, cues, origin, "planned")


def recorded_motion(
    take: Take, rate: Fraction | None, first: int = 1, *, commanded: bool = False, number: int | None = None
) -> Motion:
    """Where the axes were measured, at the times of the readings, or at frames of a given rate.

    `commanded`: where they were to be, at each tick. `number` is the pass to take, at the move's own time, else it is
    the whole run from its first tick on. Raises UnplayableError where there is nothing.
    """
    paths, missing = _paths(take, commanded, number)
    if not paths:
        what = "is empty" if not len(take.times) else "no axis was measured: --commanded has where they were to be"
        raise UnplayableError([f"{take.path}: {what}"])
    if rate is None:
        times = np.unique(np.concatenate([np.round(rows[0], 9) for rows in paths.values()]))
    else:
        begin = min(0.0, *(math.ceil(float(rows[0][0]) * rate - 1e-6) / float(rate) for rows in paths.values()))
        end = max(float(rows[0][-1]) for rows in paths.values())
        _check_rows(math.floor((end - begin) * rate) + 1, str(take.path))
        times = begin + np.arange(math.floor((end - begin) * rate + 1e-6) + 1) / float(rate)
    positions = {axis: np.interp(times, *rows) for axis, rows in paths.items()}
    kind = "commanded" if commanded else "measured"
    remarks = [f"{', '.join(missing)}: not measured; --commanded has where it was to be"] if missing else []
    cues = [] if number is not None else list(_recorded_cues(take))
    return Motion(
        take.about.title, times, positions, rate or USUAL_RATE, first, cues, str(take.path), kind, remarks=remarks
    )


def exported(motion: Motion, form: Format, ending: str, vfov: float | None) -> Exported:
    """The file of a format. Raises UsageError without its library, DocumentError for what the format cannot hold."""
    writer = form.load()
    axes = [axis for axis in form.carries if axis in motion.positions]
    if not axes and not form.cues:
        raise DocumentError([f"{motion.origin}: moves {', '.join(motion.axes)}, and {form.title} has none of them"])
    if not form.by_time and not motion.by_frame:
        raise DocumentError([f"{motion.origin}: {form.title} has a row for each frame: give --rate, as in --rate 24"])
    lost = list(not_carried(motion, form, vfov))
    options = WriteOptions(vfov, axes, lost)
    content = writer.write(motion, options, ending) if form.name == "usd" else writer.write(motion, options)
    beside = None if form.notes is None else companion.text(motion, form, axes, lost)
    return Exported(content, beside, lost, motion)


def keys_of(plan: Plan, motion: Motion) -> Motion:
    """The path with remarks of what the keys of its sequence have and frames have not."""
    keys = [key for of_axis in plan.sequence.keys.values() for key in of_axis]
    lines = ["keys, with their tension and repeats: the file has the motion itself, frame by frame"]
    if any(key.hold > SAME_TIME for key in keys):
        lines.append("holds: they are frames that stay where they are")
    if any(key.arrive or key.leave for key in keys):
        lines.append("eases: they are in the motion")
    if plan.timelapse is not None:
        lines.append("the timelapse (interval, exposure): a row is an output frame")
    return replace(motion, remarks=[*motion.remarks, *lines])


def not_carried(motion: Motion, form: Format, vfov: float | None) -> Iterator[str]:
    """A line for each thing of the path that a file of the format does not have."""
    yield from motion.remarks
    for axis in motion.axes:
        if axis not in form.carries:
            yield f"{axis}: {form.title} has no place for it"
    if motion.cues and not form.cues:
        yield f"{len(motion.cues)} cue{'s' if len(motion.cues) > 1 else ''}: export them as .otio"
    if form.name in ("chan", "usd", "blender") and vfov is None:
        zero = ": vfov is 0" if form.name == "chan" else ""
        yield f"the field of view, which a move does not have{zero}; --vfov gives it"


def _check_rows(count: int, name: str) -> None:
    if count > MOST_ROWS:
        raise DocumentError([f"{name}: would have {count} frames; give a lower --rate"])


def _paths(take: Take, commanded: bool, number: int | None) -> tuple[Mapping[Axis, tuple[Array, Array]], Sequence[str]]:
    """Times and positions by axis, and the axes of which there are none."""
    if number is not None:
        each = next((each for each in passes(take) if each.number == number), None)
        if each is None:
            known = ", ".join(str(each.number) for each in passes(take)) or "none"
            raise UnplayableError([f"{take.path}: has no pass {number}; it has {known}"])
        found = each.planned if commanded else each.measured
    elif commanded:
        found = {axis: (take.times, rows[0]) for axis, rows in take.motion.items() if len(take.times)}
    else:
        found = {axis: (rows[0], rows[1]) for axis, rows in take.measured.items()}
    kept = {axis: found[axis] for axis in Axis if axis in found and len(found[axis][0])}
    return kept, [axis.value for axis in take.axes if axis not in kept]


def _recorded_cues(take: Take) -> Iterator[TimedCue]:
    known = {action.value for action in Action}
    for time, action in take.actions:
        if action["action"] in known:
            yield TimedCue(max(0.0, time), {"camera": str(action["action"])})


def _content(action: Any) -> Mapping[str, str]:
    """As a sequence file has it."""
    if isinstance(action, Action):
        return {"camera": action.value}
    if isinstance(action, DeviceCommand):
        mode = next((name for name, command in FOLLOW.items() if command == action), None)
        return {"send": str(action)} if mode is None else {"follow": mode}
    return {"wait": "operator"}
