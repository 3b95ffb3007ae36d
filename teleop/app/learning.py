"""Passes that learn, and passes that play what was learned: what a run needs for either."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from teleop.config.documents.document import DocumentError
from teleop.config.profile import Profile
from teleop.core.axes import Axis, Limits
from teleop.core.events import DeviceCommand
from teleop.devices.rig import Rig
from teleop.learning.correction import Correction
from teleop.learning.correction_file import read_correction, write_correction
from teleop.learning.pass_learner import PassLearner, Subject
from teleop.learning.pass_traces import PassObserver
from teleop.planner.trajectory import Move
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.cues import Wait
from teleop.sequence.cycle import Corrector, Cycle
from teleop.sequence.fingerprint import fingerprint
from teleop.sequence.source import SequenceSource

SETTLE = 4.0  # s: a gimbal that is corrected late rings for so long


@dataclass(frozen=True)
class Known:
    """A corrector that does not learn: every pass plays `move`."""

    move: Move

    def ended(self, number: int) -> None: ...

    def next_move(self) -> Move:
        return self.move


class AtOnce(Executor):
    """Does it in the calling thread: on the virtual clock no time passes meanwhile, and each run is the same."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_result(fn(*args, **kwargs))
        return future


def learned(path: Path, profile: Profile, sequence: CompiledSequence, limits: Mapping[Axis, Limits]) -> Correction:
    """The correction in a file, for this rig and this sequence.

    Raises DocumentError, with one line, where it is of another rig or move, or damaged.
    """
    found = read_correction(path)
    if found.rig != profile.name:
        raise DocumentError([f"{path}: was learned on {found.rig}, not on {profile.name}: learn it again on this rig"])
    if found.sequence != fingerprint(sequence):
        of = f" ({found.title})" if found.title != sequence.title else ""
        raise DocumentError(
            [f"{path}: was learned for another move{of}; or the move, or the limits, were edited since"]
        )
    if strangers := [axis for axis in found.offsets if axis not in sequence.move.tracks]:
        raise DocumentError([f"{path}: corrects {', '.join(strangers)}, which the move does not have"])
    if beyond := found.exceeds(sequence.move, limits):
        raise DocumentError([f"{path}: takes {', '.join(beyond)} beyond the limits of {profile.name}: learn it again"])
    return found


def learner(
    profile: Profile,
    sequence: CompiledSequence,
    file: Path,
    known: Correction | None,
    virtual: bool,
    triggered: bool,
    notify: Callable[[str], object],
) -> PassLearner:
    """What learns a sequence and keeps the best in `file`; one that waits for a trigger does not begin before it."""
    rests = [cue.at for cue in sequence.cues if isinstance(cue.action, Wait | DeviceCommand)]
    subject = Subject(
        profile.name,
        sequence.title,
        fingerprint(sequence),
        sequence.move,
        {axis: profile.limits[axis] for axis in sequence.move.tracks},
        rests,
        not triggered,
    )
    executor = AtOnce() if virtual else ThreadPoolExecutor(1, thread_name_prefix="learning")
    return PassLearner(subject, executor, notify, partial(write_correction, file), known)


def corrected(cycle: Cycle, corrector: Corrector) -> Cycle:
    """Passes that are corrected, each from rest: what the ease before it has left would not be the same again."""
    return replace(cycle, corrector=corrector, preroll=max(cycle.preroll, SETTLE))


def observe_passes(learner: PassLearner, source: SequenceSource, rig: Rig) -> PassObserver:
    """What sees the passes of a source on a rig for the learner."""
    learner.observer = PassObserver(source.place, lambda: source.move, lambda: source.waiting, lambda: rig.relied_on)
    return learner.observer
