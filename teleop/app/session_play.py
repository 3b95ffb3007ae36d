"""Plays a planned move on a rig that a program has opened, and reports how well the rig followed."""

# pyright: strict

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from teleop.app.move import Move
from teleop.app.played_status import PlayedStatus, as_planned, facts_of
from teleop.app.program import SourceJob, StoppedError
from teleop.app.session import Session
from teleop.config.documents.document import UnplayableError
from teleop.core.axes import Axis
from teleop.core.errors import DeviceError, LinkError, UsageError
from teleop.core.events import Action
from teleop.core.interfaces import Observer
from teleop.core.run_state import Result
from teleop.monitors.tracking_error import Score, TrackingErrorMonitor
from teleop.planner.keyframes.findings import PlanError
from teleop.recording.writer import recording
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.cycle import Cycle
from teleop.sequence.source import SequenceSource

if TYPE_CHECKING:
    from teleop.learning.correction import PassFigures
    from teleop.learning.pass_learner import PassLearner

log = logging.getLogger(__name__)

SLACK = 1e-6  # of a limit: a plan that uses all of it is within it


@dataclass(frozen=True)
class AxisReport:
    """How far the readings of one axis were from what was commanded at their time, in units."""

    readings: int
    rms: float
    peak: float


@dataclass(frozen=True)
class Report:
    """How a run went. `ok` is True when it reached its end; else `reason` says what ended it.

    `seconds` is how long the move took, `axes` has an AxisReport by axis name, `take` is the file recorded to.
    `passes` has the same for each pass of a run that learns.
    """

    ok: bool
    reason: str
    seconds: float
    axes: Mapping[str, AxisReport]
    take: Path | None = None
    passes: Sequence[Mapping[str, AxisReport]] = ()


@dataclass(frozen=True)
class Passes:
    """How often a move is played; `learn` is the file to keep a correction in, `learned` one to begin with."""

    count: int = 1
    learn: Path | None = None
    learned: Path | None = None


ONCE = Passes()


def play(session: Session, move: Move, take: Path | None, speed: float, passes: Passes = ONCE) -> Report:
    """Ease to the first keyframe, then the move at `speed`, a share of the written one; recorded to `take`.

    A fault and a STOP are in the report. Raises UsageError and UnplayableError before anything moves.
    """
    session.check()
    _refuse(session, move)
    try:
        cycle, learns = _cycle(session, move, passes)
        source = SequenceSource(move.compiled, session.profile.limits, speed, cycle=cycle)
    except PlanError as error:
        raise UnplayableError([f"play: speed={speed:g}: {error}"]) from None
    monitor = TrackingErrorMonitor(lambda: source.begin, partial(as_planned, source, move.compiled.move))
    observers: list[Observer] = [monitor]
    if learns is not None:
        from teleop.app.learning import observe_passes

        observers.append(observe_passes(learns, source, session.rig))
    if session.program.stopped:
        return _report(move.compiled, monitor, "STOPPED: call clear() first, then play again", None)
    reason, result, facts = "", Result.INTERRUPTED, facts_of(move.compiled)
    rig, limits = session.profile.name, {axis: session.profile.limits[axis] for axis in session.axes}
    with recording(
        take, rig, move.title, limits, patient=session.is_virtual, option="take=", sequence=facts
    ) as recorder:
        if recorder is not None:
            recorder.status = played = PlayedStatus(source, move.compiled.move, session.rig)
            observers += [played, recorder]
        session.rig.foresee(source.foreseen)
        source.rest_needed = partial(session.rig.rest_needed, move.axes)
        try:
            session.run(SourceJob(source, session.camera_waiting), observers)
            result = Result.DONE
        except StoppedError as error:
            reason = str(error)
        except (DeviceError, LinkError) as error:
            reason, result = str(error), Result.FAILED
        finally:
            session.rig.foresee(None)
            if recorder is not None:
                recorder.finish(result, [reason] if reason else [])
    if learns is not None:
        learns.finish()
    return _report(move.compiled, monitor, reason, take, learns)


def _cycle(session: Session, move: Move, passes: Passes) -> tuple[Cycle, PassLearner | None]:
    """What surrounds the move, and what learns from it. Raises DocumentError for a file that does not fit."""
    compiled, profile = move.compiled, session.profile
    plain = Cycle(compiled.preroll, passes=passes.count, compared=passes.count > 1, back_to_one=compiled.back_to_one)
    if passes.learn is None and passes.learned is None:
        return plain, None
    from teleop.app.learning import Known, corrected, learned, learner

    known = passes.learned and learned(passes.learned, profile, compiled, profile.limits)
    if passes.learn is not None:
        learns = learner(profile, compiled, passes.learn, known, session.is_virtual, False, log.info)
        return corrected(plain, learns), learns
    return (plain if known is None else corrected(plain, Known(known.applied(compiled.move)))), None


def _refuse(session: Session, move: Move) -> None:
    """Raises what keeps this rig from the move: it may have been planned for another one."""
    axes, rig = move.axes, session.profile.name
    if flown := [axis for axis in axes if axis.is_stick]:
        raise UsageError(f"play: {', '.join(flown)} fly a drone, which needs an operator: use `teleop play`")
    if missing := [axis for axis in axes if axis not in session.axes]:
        raise UnplayableError([f"{move.title}: {rig} has no axis {', '.join(missing)}"])
    if session.rig.camera is None and any(isinstance(cue.action, Action) for cue in move.compiled.cues):
        raise UnplayableError([f"{move.title}: has cues for a camera, and {rig} has none"])
    if move.profile.limits == session.profile.limits:
        return
    if beyond := [axis for axis in axes if _is_beyond(session, move, axis)]:
        found = f"{', '.join(beyond)} would exceed the limits of {rig}"
        raise UnplayableError([f"{move.title}: {found}: plan it for this rig with plan(..., rig=)"])


def _is_beyond(session: Session, move: Move, axis: Axis) -> bool:
    peaks, limits = move.peaks()[axis.value], session.profile.limits[axis]
    shares = peaks.velocity / limits.velocity, peaks.acceleration / limits.acceleration, peaks.jerk / limits.jerk
    inside = limits.minimum - SLACK <= peaks.minimum and peaks.maximum <= limits.maximum + SLACK
    return max(shares) > 1 + SLACK or not inside


def _report(
    compiled: CompiledSequence,
    monitor: TrackingErrorMonitor,
    reason: str,
    take: Path | None,
    learns: PassLearner | None = None,
) -> Report:
    """Of a run that ended for `reason`, "" for its own end; it has every axis of the move, and no other."""
    axes: dict[str, AxisReport] = {}
    for axis in compiled.move.tracks:
        score = monitor.scores.get(axis, Score())
        axes[axis.value] = AxisReport(score.readings, score.rms, score.peak)
    passes = [_pass_report(each) for each in learns.passes] if learns else []
    return Report(not reason, reason, monitor.seconds, axes, take, passes)


def _pass_report(figures: PassFigures) -> Mapping[str, AxisReport]:
    errors = figures.errors.items()
    return {axis.value: AxisReport(error.readings, error.rms, error.worst) for axis, error in errors}
