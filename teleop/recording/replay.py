"""A take as a compiled sequence: what was commanded once is commanded again.

The states of the ticks are known exactly, so a quintic leads from each to the next, and on the loop's grid the stream
is the recording. What lies between two ticks is never sent. Whether a step is legal is therefore asked of its two
states, as the planner does, and not of the quintic, which swings beyond a jerk that was switched within the tick.

A recording begins after its first step and, when it was cut off, ends in full motion. Both ends are completed: with a
few ticks from rest to the first state, and with the fastest stop from the last.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from teleop.config.documents.document import UnplayableError
from teleop.config.profile import Profile
from teleop.core.axes import Axis, Limits, State
from teleop.core.events import Action
from teleop.core.guard_stop import stop_phases, stop_state
from teleop.core.timing import PERIOD
from teleop.planner.polynomial import Array
from teleop.planner.trajectory import Move, Peaks, Track
from teleop.recording.legality import ALLOWED, Excess, excess
from teleop.recording.reader import Take, read_take
from teleop.sequence.compile import CompiledSequence, Cue

LEAD = 5 * PERIOD  # s from rest to a first tick that moves: time enough for hardly any jerk
SAME_TICK = 1e-6  # s: times that are closer are the same tick


class Samples(NamedTuple):
    """One axis at the ticks: `times` (n,) in s, rising, and rows position, velocity, acceleration (3, n)."""

    times: Array
    states: Array

    @property
    def steps(self) -> Array:
        """The periods between the samples, in s."""
        return np.diff(self.times)


class RecordedTrack(Track):
    """A track whose peaks are those of the recorded states, not of the quintics between them."""

    samples: Samples

    def peaks(self) -> Peaks:
        times, (position, velocity, acceleration) = self.samples
        jerk = np.abs(np.diff(acceleration)) / np.diff(times)
        fastest, hardest, sharpest = (float(np.abs(row).max(initial=0.0)) for row in (velocity, acceleration, jerk))
        return Peaks(fastest, hardest, sharpest, float(position.min()), float(position.max()))


def take_performance(path: Path, limits: Mapping[Axis, Limits], rig: str) -> CompiledSequence:
    """The take in a file, checked against the limits of a rig.

    Raises DocumentError for what is no take, UnplayableError for what this rig cannot repeat.
    """
    take = read_take(path)
    missing = [axis for axis in take.axes if axis not in limits]
    if missing:
        raise UnplayableError([f"{path}: moves {', '.join(missing)}, but {rig} has only {', '.join(limits)}"])
    if not len(take.times):
        raise UnplayableError([f"{path}: is empty: the run ended before its first tick"])
    move = recorded_move(take, limits)
    problems = [f"{path}: {wrong} ({rig})" for wrong in _excesses(move, limits)]
    if problems:
        raise UnplayableError(problems)
    return CompiledSequence(take.about.title, move, cues(take), warnings(take), {axis: [] for axis in take.axes})


def followable(profile: Profile) -> Profile:
    """The rig with what is ALLOWED added to its limits, for the planner that follows a take; soft limits stay.

    A recording at full jerk that had to be met to the last bit would now and then be out of reach, and once the
    planner has lost its reference it meets it again seconds later.
    """
    axes = {}
    for axis, section in profile.axes.items():
        wider = {name: getattr(section, name) * (1 + ALLOWED) for name in ("velocity", "acceleration", "jerk")}
        axes[axis] = section.model_copy(update=wider)
    return profile.model_copy(update={"axes": axes})


def recorded_move(take: Take, limits: Mapping[Axis, Limits]) -> Move:
    """The commanded motion from the first tick on; `limits` are for the stop after a recording that was cut."""
    return Move({axis: _track(samples(take, axis, limits[axis])) for axis in take.axes})


def samples(take: Take, axis: Axis, limits: Limits) -> Samples:
    """The axis at every tick, completed at both ends and, where the loop slept, at rest until it moved again."""
    times, states = take.times + lead(take), take.motion[axis]
    fresh = np.concatenate([[True], np.diff(times) > SAME_TICK])
    times, states = times[fresh], states[:, fresh]
    resting = ~states[1:, :-1].any(axis=0)
    slept = np.flatnonzero((np.diff(times) > 1.5 * PERIOD) & resting)
    times = np.insert(times, slept + 1, times[slept + 1] - PERIOD)
    states = np.insert(states, slept + 1, states[:, slept], axis=1)
    return _stopped(_begun(Samples(times, states), limits), limits)


def lead(take: Take) -> float:
    """Seconds from the begin of the move to the first tick: LEAD if an axis had then begun to move, else 0."""
    moving = any(of_axis[1:, 0].any() for of_axis in take.motion.values())
    return LEAD if moving else 0.0


def _begun(recorded: Samples, limits: Limits) -> Samples:
    """With the rest that the first tick came from, where the way there has the least jerk."""
    times, states = recorded
    position, velocity, acceleration = states[:, 0]
    if times[0] == 0:
        return recorded
    before = position - times[0] * (velocity / 2 - acceleration * times[0] / 12)
    before = np.clip(before, limits.minimum, limits.maximum)
    return Samples(np.insert(times, 0, 0.0), np.insert(states, 0, [before, 0.0, 0.0], axis=1))


def _stopped(recorded: Samples, limits: Limits) -> Samples:
    """With the fastest stop after the last state, if that is not at rest."""
    times, states = recorded
    last = State(*states[:, -1].tolist())
    if last.velocity == 0 and last.acceleration == 0:
        return recorded
    seconds = sum(each for each, _ in stop_phases(*last[1:], limits.acceleration, limits.jerk))
    after = np.arange(1, math.ceil(seconds / PERIOD) + 1) * PERIOD
    stops = [stop_state(last, limits.acceleration, limits.jerk, each) for each in after.tolist()]
    return Samples(np.concatenate([times, times[-1] + after]), np.hstack([states, np.array(stops).T]))


def _track(recorded: Samples) -> RecordedTrack:
    """A quintic a tick, what rests in one piece."""
    times, states = recorded
    first = _first_of_rests(states)
    track = RecordedTrack.through(times[first], states[:, first])
    object.__setattr__(track, "samples", recorded)
    return track


def _first_of_rests(states: Array) -> NDArray[np.intp]:
    """The samples that a track needs: all but those within a rest."""
    still: NDArray[np.bool_] = np.all(states[1:] == 0, axis=0)
    same = still[1:] & still[:-1] & (np.diff(states[0]) == 0)  # nothing happens in this step
    within = np.concatenate([[False], same[1:] & same[:-1], [False]])
    return np.flatnonzero(~within)


def _excesses(move: Move, limits: Mapping[Axis, Limits]) -> Iterator[str]:
    """Where the take is too much for the limits: the worst of each axis and limit."""
    for axis, track in move.tracks.items():
        assert isinstance(track, RecordedTrack)
        for each in excess(track.samples.times, track.samples.states, limits[axis]):
            yield _excess_text(axis, each)


def _excess_text(axis: Axis, wrong: Excess) -> str:
    if wrong.limit in ("minimum", "maximum"):
        return f"at {wrong.time:.2f} s {axis} is {wrong.size:.6g} beyond its {wrong.limit}"
    return f"at {wrong.time:.2f} s {axis} needs {wrong.size:.3g} x its {wrong.limit} limit"


def cues(take: Take) -> Sequence[Cue]:
    """The camera's actions, each at its tick; times are those of `recorded_move`."""
    known = {action.value: action for action in Action}
    commands = [(time, known[action["action"]]) for time, action in take.actions if action["action"] in known]
    return [Cue(max(0.0, time + lead(take)), action) for time, action in commands]


def warnings(take: Take) -> list[str]:
    """Lines for the user: what is missing in a take, and what of it is not replayed."""
    found = []
    commands = [action["words"] for _, action in take.actions if action["action"] == "told"]
    if commands:
        found.append(f"{take.path}: commands not replayed: {'; '.join(dict.fromkeys(commands))}")
    if take.remark:
        found.append(take.remark)
    if take.cut:
        found.append(
            f"{take.path}: the recording was cut off at {take.duration:.2f} s; axes that were moving are stopped there"
        )
    elif take.ending and take.ending.dropped:
        found.append(f"{take.path}: {take.ending.dropped} ticks were not recorded; they are interpolated")
    return found
