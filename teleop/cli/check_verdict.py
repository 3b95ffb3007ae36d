"""The last lines of `teleop check`: how fast each axis is and where, how near a table it is, and whether that does."""

from __future__ import annotations

from collections.abc import Iterator

from teleop.app.check import FramesCheck, MoveCheck
from teleop.app.planning import Plan
from teleop.cli.options import Options
from teleop.config.documents.document import DocumentError, UnplayableError
from teleop.core.axes import Axis


def verdict(plan: Plan, found: MoveCheck) -> Iterator[str]:
    """A line for each axis, for each remark, and the verdict."""
    width = max((len(_name(axis)) for axis in found.axes), default=0)
    for axis, use in found.axes.items():
        unit = f" {axis.unit}/s" if axis.unit else " /s"
        limit = plan.profile.limits[axis].velocity
        speed = f"peak {_figure(use.peak_velocity)} of {limit:g}{unit} at {use.peak_at:.1f} s"
        yield f"{_name(axis):{width}}  {speed if use.peak_velocity else 'does not move'}"
    for axis, each in found.frames.items():
        yield _frames(axis, each)
    for remark in found.remarks:
        yield f"Remark: {remark}."
    count = len(plan.warnings) + len(found.remarks)
    notes = "" if not count else f", with {count} warning{'s' if count > 1 else ''}"
    yield f"OK: {plan.profile.name} can {'shoot' if plan.timelapse else 'play'} this{notes}."


def refusal(error: DocumentError, options: Options) -> str:
    """The verdict where there is no plan, of a sequence that the rig cannot play or a file with mistakes."""
    count = len(error.problems) + error.more
    problems = f"{count} problem{'s' if count > 1 else ''}"
    what = f"{options.profile().name} cannot play this" if isinstance(error, UnplayableError) else "this cannot be read"
    return f"Not OK: {what}, {problems}."


def _name(axis: Axis) -> str:
    return axis.value.replace("_", " ")


def _figure(value: float) -> str:
    """Three digits, as many behind the point as a figure next to it would have: 24.0, 8.79, 0.143."""
    return f"{value:.1f}" if value >= 10 else f"{value:.3g}"


def _frames(axis: Axis, found: FramesCheck) -> str:
    unit = f" {axis.unit}".rstrip()
    near = f"within {found.off:.3f} of {found.tolerance:g}{unit}, worst at frame {found.frame}"
    return f"{found.table}: {_name(axis)} is {near}; {found.keys} keys for {found.frames} frames"
