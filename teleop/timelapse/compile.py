"""A sequence file with a `timelapse:` section, compiled: where the axes are at each frame, and when it is due.

The path is planned over output frames, because that is what the clip will show, and only then put on a clock: the
shoot's, where an interval may be ramped, or the clip's own, to rehearse. Whether the interval can hold what one frame
takes is known before anything moves, so a file in which it cannot is refused with the frame where it is tightest.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from hashlib import sha256
from typing import NamedTuple

import numpy as np

from teleop.config.documents.document import Document, DocumentError, UnplayableError, numbered
from teleop.config.documents.yaml_loader import read_document
from teleop.config.frame_rates import shown_rate
from teleop.config.quantities import seconds
from teleop.config.resources import find
from teleop.core.axes import Axis, Limits
from teleop.planner.go_motion import ExposureRuns
from teleop.planner.keyframes.findings import Infeasible
from teleop.planner.keyframes.planner import Key, stretch
from teleop.planner.polynomial import Array
from teleop.planner.time_scaling import at_most
from teleop.planner.trajectory import Move, Track
from teleop.sequence.aim import UnaimedError
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.keys import axes_of, keys_of, line_at
from teleop.sequence.model import SequenceModel
from teleop.sequence.refusal import refusal
from teleop.sequence.rules import file_rules, rig_rules
from teleop.sequence.timelapse_section import TimelapseSection, is_timelapse
from teleop.sequence.timeline import Origin, aims_of
from teleop.sequence.turns import long_ways, unwrapped
from teleop.timelapse.blur_rules import blur_problem
from teleop.timelapse.budget import Phases, budget
from teleop.timelapse.schedule import Schedule

SHOWN_AT = 24.0  # frames a second, of a rehearsal where the file does not say it


class FramePath(NamedTuple):
    """Where the axes are over the frames of a shoot: `move` in its own seconds, of which each frame takes `step`.

    Frame 0 is the first that is shot, `lead` frames before the move begins.
    """

    move: Move
    step: float
    lead: int

    def at(self, frame: float) -> dict[Axis, float]:
        """Positions in units."""
        return {axis: state.position for axis, state in self.move.at((frame - self.lead) * self.step).items()}

    def positions(self, count: int) -> dict[Axis, Array]:
        """Each axis at frames 0 .. count - 1."""
        samples = self.move.sample((np.arange(count, dtype=float) - self.lead) * self.step)
        return {axis: rows[0] for axis, rows in samples.items()}

    def on(self, slots: Schedule) -> Move:
        """The move in real time: at each frame it is there when the frame is due."""
        return Move({axis: self._track(track, slots) for axis, track in self.move.tracks.items()})

    def _track(self, track: Track, slots: Schedule) -> Track:
        frames = track.breaks / self.step + self.lead
        if slots.change:  # otherwise a quintic over frames is one over seconds
            frames = np.union1d(frames, np.arange(np.ceil(frames[0]), frames[-1]))
        times = np.array([slots.at(frame) for frame in frames.tolist()])
        speed, change = np.array([slots.speed(frame) for frame in frames.tolist()]).T
        position, velocity, acceleration, _ = track.sample((frames - self.lead) * self.step)
        position[-1] = track.end
        velocity, acceleration = velocity * self.step, acceleration * self.step**2
        states = np.array([position, velocity * speed, acceleration * speed**2 + velocity * change])
        states[1:, -1] = 0.0
        return Track.through(times, states)


@dataclass(frozen=True)
class Timelapse:
    """A timelapse compiled for a rig. `moving` are its frames without the still ones, `delay` is in s.

    `go_on` is whether a camera that does not shoot is only counted. `warnings` are lines for the user. `identity` is
    the same for files that say the same, includes and all, whatever their comments are. `runs` are those through the
    exposures (go-motion), None where there is no blur.
    """

    title: str
    fps: float | None
    slots: Schedule
    path: FramePath
    phases: Phases
    continuous: bool
    moving: int
    delay: float
    go_on: bool
    limits: Mapping[Axis, Limits]
    keys: Mapping[Axis, Sequence[Key]]
    warnings: Sequence[str]
    identity: str
    runs: Mapping[Axis, ExposureRuns] | None = None

    @property
    def frames(self) -> int:
        return self.slots.frames

    @property
    def clip(self) -> float | None:
        """How long the clip is, in s; None where its frames per second are not known."""
        return self.frames / self.fps if self.fps else None

    def rehearsal(self) -> CompiledSequence:
        """The whole move at the clip's own speed, or as fast as the limits allow; its warnings are about just that."""
        fps = self.fps or SHOWN_AT
        warnings = (
            [] if self.fps else [f"{self.title}: fps is not given: rehearsed at {shown_rate(fps)} frames a second"]
        )
        slots = Schedule(1 / fps, 1 / fps, self.frames)
        most = at_most(self.path.on(slots), self.limits)
        if most < 1:
            slots = slots.scaled(1 / most)
            warnings.append(f"{self.title}: rehearsed {1 / most:.2f} x slower than the clip, to keep the rig's limits")
        lead, keys = slots.at(self.path.lead), {}
        for axis, of_axis in self.keys.items():
            scaled = [key.later(slots.first) for key in of_axis]
            keys[axis] = [replace(key, at=key.at + lead) for key in scaled]
        return CompiledSequence(self.title, self.path.on(slots), [], warnings, keys)


def load_timelapse(name: str, limits: Mapping[Axis, Limits], rig: str, by_hand: bool = False) -> Timelapse | None:
    """The timelapse in the sequence file called `name`; None for a file without one.

    `by_hand` is whether an operator shoots each frame: then no interval has to hold it. Raises DocumentError with a
    line for everything wrong with it; UnplayableError when only the rig is in the way.
    """
    document = read_document(*find(name, "sequences", "sequence"))
    if not is_timelapse(document.data):
        return None
    beyond_rig = list(rig_rules(document.data, limits, rig))
    try:
        model = document.check(SequenceModel, [*file_rules(document.data), *beyond_rig])
    except DocumentError as error:
        raise (UnplayableError(error.problems) if len(error.problems) == len(beyond_rig) else error) from None
    assert model.timelapse is not None
    return _compiled(document, model, model.timelapse, {axis: limits[axis] for axis in axes_of(model)}, by_hand)


def _compiled(
    document: Document, model: SequenceModel, section: TimelapseSection, limits: Mapping[Axis, Limits], by_hand: bool
) -> Timelapse:
    slots = _slots(section, model.fps)
    phases = Phases.of(section, model.fps)
    in_frames = model.model_copy(update={"fps": 1.0})  # a frame for a second
    try:
        keys, aims = unwrapped(keys_of(in_frames), model, limits), aims_of(document, in_frames)
    except UnaimedError as error:
        raise DocumentError([document.problem(error.place, f": {error}")]) from None
    step = slots.at(slots.frames - 1) / (slots.frames - 1) if slots.frames > 1 else slots.first
    timed = {axis: [key.later(step) for key in of_axis] for axis, of_axis in keys.items()}
    try:
        move, factor = stretch(timed, limits, model.tension)
    except Infeasible as error:
        places = {numbered("keyframes", i): Origin(document, ("keyframes", i)) for i in range(len(model.keyframes))}
        raise refusal(error, places) from None
    if problems := [text for aimed in aims if (text := aimed.problem(move, step * factor))]:
        raise UnplayableError(problems)
    path = FramePath(move, step * factor, section.lead_in)
    continuous = section.mode == "continuous"
    runs = _runs(document, section, path.positions(slots.frames), phases.exposure, limits)
    problems, warnings = ([], []) if by_hand else budget(phases, slots, path, limits, continuous, runs)
    if problems:
        raise UnplayableError([document.problem(("timelapse", "interval"), text) for text in problems])
    remarks = [line_at(document, remark.last, str(remark)) for remark in move.remarks]
    remarks += [document.line(("keyframes", frame), text) for frame, text in long_ways(keys, limits)]
    remarks += [document.problem(("timelapse", "interval"), text) for text in warnings]
    return Timelapse(
        model.called(document.name),
        model.fps,
        slots,
        path,
        phases,
        continuous,
        section.frames,
        seconds(section.delay, model.fps),
        section.on_camera_fault == "continue",
        limits,
        keys,
        remarks,
        _identity(model, section, keys),
        runs,
    )


def _runs(
    document: Document,
    section: TimelapseSection,
    positions: Mapping[Axis, Array],
    exposure: float,
    limits: Mapping[Axis, Limits],
) -> Mapping[Axis, ExposureRuns] | None:
    """Those through the exposures. Raises UnplayableError where one breaks a limit."""
    if not section.blur:
        return None
    runs = {
        axis: ExposureRuns.along(places, section.blur, exposure, limits[axis]) for axis, places in positions.items()
    }
    if problem := blur_problem(runs):
        raise UnplayableError([document.problem(("timelapse", "blur"), problem)])
    return runs


def _slots(section: TimelapseSection, fps: float | None) -> Schedule:
    count = section.lead_in + section.frames + section.lead_out
    if isinstance(section.interval, Mapping):
        return Schedule(seconds(section.interval["from"], fps), seconds(section.interval["to"], fps), count)
    interval = seconds(section.interval, fps)
    return Schedule(interval, interval, count)


def _identity(model: SequenceModel, section: TimelapseSection, keys: Mapping[Axis, Sequence[Key]]) -> str:
    content = repr(
        [model.fps, model.tension, section.model_dump(), {axis.value: list(of) for axis, of in keys.items()}]
    )
    return sha256(content.encode()).hexdigest()
