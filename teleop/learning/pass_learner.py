"""Learns from pass to pass of one run: what each pass measured corrects the next.

The arithmetic of a pass takes longer than a tick. It runs in an executor while the axes return to the start, and the
next pass waits for it there, at rest. Times of a correction begin before the move's own zero and last beyond its end,
because a gimbal that is late must be sent early; a move that waits for a trigger cannot begin before that.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass, replace

from teleop.core.axes import Axis, Limits
from teleop.learning.axis_learner import AxisLearner
from teleop.learning.correction import Correction, Error, PassFigures
from teleop.learning.pass_traces import CHANGED, PassObserver, PassTraces
from teleop.planner.offset_track import added
from teleop.planner.trajectory import Move

LEAD = 0.3  # s before the move's zero, and after its end: a gimbal may be that late


@dataclass(frozen=True)
class Subject:
    """What is learned about: the rig's name, the sequence's title and fingerprint, its plan and the rig's limits.

    `rests` are times (s) at which every axis has to rest, beside both ends; with `leads` a pass may begin early.
    """

    rig: str
    title: str
    fingerprint: str
    plan: Move
    limits: Mapping[Axis, Limits]
    rests: Sequence[float] = ()
    leads: bool = True


class PassLearner:
    """`known` is a correction to begin with. `notify` gets the lines about each pass; `save` what is best so far."""

    def __init__(
        self,
        subject: Subject,
        executor: Executor,
        notify: Callable[[str], object],
        save: Callable[[Correction], object],
        known: Correction | None = None,
    ) -> None:
        self._subject, self._executor, self.save = subject, executor, save
        self.notify = notify
        self._known = known
        self.observer: PassObserver | None = None  # given by the run, as soon as there is a source to observe
        self.passes: list[PassFigures] = list(known.passes) if known else []
        self._earlier = max((each.number for each in self.passes), default=0)
        self._job: Future[tuple[Move, list[str]]] | None = None
        self._learners: dict[Axis, AxisLearner] = {}
        self.move = known.applied(subject.plan) if known else subject.plan
        self.saved = False

    def ended(self, number: int) -> None:
        """Pass `number` of this run is over; learning from it begins."""
        assert self.observer is not None
        self._job = self._executor.submit(self._learn, self.observer.taken(number))

    def next_move(self) -> Move | None:
        """What to play next; None while that is not known."""
        if self._job is not None:
            if not self._job.done():
                return None
            self._take()
        return self.move

    def finish(self) -> None:
        """Wait for what is being learned; the run is over."""
        if self._job is not None:
            self._take()

    @property
    def correction(self) -> Correction | None:
        """The best so far, of no axis where none is better than nothing; None before a pass has taught."""
        offsets, best = {}, {}
        for axis, learner in self._learners.items():
            if learner.best_error is not None and learner.best.coefficients.any():
                offsets[axis], best[axis] = learner.best, learner.best_pass
        of = self._subject
        return Correction(of.rig, of.title, of.fingerprint, offsets, best, self.passes) if self.best else None

    @property
    def best(self) -> Mapping[Axis, tuple[int, Error]]:
        """Of each axis that learns, the number of the best pass and its error."""
        learners = self._learners.items()
        return {axis: (each.best_pass, each.best_error) for axis, each in learners if each.best_error is not None}

    def _take(self) -> None:
        assert self._job is not None
        self.move, lines = self._job.result()
        self._job = None
        for line in lines:
            self.notify(line)

    def _learn(self, traces: PassTraces) -> tuple[Move, list[str]]:
        """In the executor: the next pass's move, and what there is to say."""
        plan, number = self._subject.plan, self._earlier + traces.number
        errors = {axis: error for axis, track in plan.tracks.items() if (error := traces.error(axis, track))}
        figures = PassFigures(number, errors, CHANGED if traces.changed else "")
        self.passes.append(figures)
        lines = list(pass_lines(figures, list(plan.tracks)))
        if traces.changed:
            return self.move, lines
        before = {axis: each.ended for axis, each in self._learners.items()}
        for axis, track in plan.tracks.items():
            if axis.is_angle and axis in errors and track.peaks().velocity > 0:
                if traces.has_gaps(axis, track):
                    lines.append(f"pass {number}: {axis} was measured too rarely to learn from")
                    continue
                settled = axis not in traces.identified
                self._learner(axis).learn(number, errors[axis], traces.readings[axis], settled)
                if not settled:
                    lines.append(f"pass {number}: {axis} was identified in it: the next pass has the same correction")
        for axis, each in self._learners.items():
            if each.ended and not before.get(axis) and each.best_error is not None:
                at_best = f"pass {each.best_pass} is the best, RMS {each.best_error.rms:.3f}"
                lines.append(f"{axis}: learning ends: {each.ended}; {at_best}")
        if (found := self.correction) is not None:
            self.save(found)
            self.saved = True
        return self._next(), lines

    def _next(self) -> Move:
        """The plan with the offsets that are tried next; itself where there are none."""
        plan, offsets = self._subject.plan, {axis: each.offset for axis, each in self._learners.items()}
        if not self._known and not any(offset.coefficients.any() for offset in offsets.values()):
            return plan
        tracks = {
            axis: added(track, offsets[axis]) if axis in offsets else self.move.tracks[axis]
            for axis, track in plan.tracks.items()
        }
        return replace(plan, tracks=tracks)

    def _learner(self, axis: Axis) -> AxisLearner:
        if axis not in self._learners:
            of = self._subject
            lead, end = LEAD if of.leads else 0.0, of.plan.duration
            inner = sorted(each for each in set(of.rests) if 0 < each < end)
            present = self._known.offsets.get(axis) if self._known else None
            self._learners[axis] = AxisLearner(
                of.plan.tracks[axis], of.limits[axis], [-lead, *inner, end + LEAD], present
            )
        return self._learners[axis]


def pass_lines(figures: PassFigures, axes: Sequence[Axis]) -> Sequence[str]:
    """One line for each axis of a pass."""
    lines = []
    for axis in axes:
        if (error := figures.errors.get(axis)) is None:
            lines.append(f"pass {figures.number}: {axis} was not measured")
            continue
        places = 3 if axis.is_angle else 4
        unit = " deg" if axis.is_angle else ""
        found = f"RMS {error.rms:.{places}f}{unit}, worst {error.worst:.{places}f}{unit} at {error.at:.2f} s"
        lines.append(f"pass {figures.number}: {axis} {found}")
    if figures.ignored:
        lines.append(f"pass {figures.number} teaches nothing: {figures.ignored}")
    return lines
