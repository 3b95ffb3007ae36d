"""How far a sequence is, for people: in a few words, and as the status that a view shows."""

from __future__ import annotations

import math
from bisect import bisect_right

from teleop.core.run_status import NextCue, NextKey, RunStatus
from teleop.core.timing import SAME_TIME
from teleop.sequence.phases import SequencePhase
from teleop.sequence.source import SequenceSource

_LABELS = {
    SequencePhase.EASING: "to the start",
    SequencePhase.PREROLL: "starts in",
    SequencePhase.REJOINING: "back to the path",
    SequencePhase.RETURNING: "back to one",
}


def progress_text(sequence: SequenceSource, now: float) -> str:
    """What it is doing at `now`, and how far that is."""
    if sequence.phase in _LABELS:
        return f"{_LABELS[sequence.phase]} {max(0.0, sequence.until - now):4.1f} s"
    if sequence.phase is SequencePhase.ARMED:
        return f"waiting for {sequence.cycle.trigger.waits_for(now)}" if sequence.cycle.trigger else ""
    elapsed = sequence.playback.time(now)
    if sequence.waiting:
        return f"{elapsed:6.1f} / {sequence.duration:.1f} s  waiting for you"
    if _runs_up(sequence, now):
        return f"run-up to {sequence.cycle.start_at:.1f} s"
    time = f"{min(max(elapsed, 0.0), sequence.duration):6.1f} / {sequence.duration:.1f} s"
    if not sequence.cycle.repeats:
        return time
    of = "" if sequence.cycle.endless else f" of {sequence.cycle.passes:.0f}"
    return f"{time}  pass {sequence.number}{of}"


def run_status(sequence: SequenceSource, now: float) -> RunStatus:
    """What a view shows of it at `now`."""
    playback, cycle = sequence.playback, sequence.cycle
    playing = sequence.phase in (SequencePhase.PLAYING, SequencePhase.REJOINING)
    over = sequence.phase in (SequencePhase.RETURNING, SequencePhase.OVER)
    played = min(max(0.0, playback.time(now)), sequence.duration)
    elapsed = played if playing else sequence.duration if over else None
    from_here = elapsed if elapsed is not None else cycle.start_at
    speed = playback.chosen
    return RunStatus(
        phase=_phase_text(sequence, now),
        elapsed=elapsed,
        duration=sequence.duration,
        left=(sequence.duration - from_here) / speed if speed > 0 else None,
        key=None if over else _next_key(sequence, from_here),
        cue=None if over else _next_cue(sequence),
        speed=speed,
        paused=playing and playback.paused and not sequence.waiting,
        number=sequence.number,
        passes=cycle.passes,
    )


def _phase_text(sequence: SequenceSource, now: float) -> str:
    """The phase in a few words, and how long it lasts where that is known."""
    if sequence.phase is SequencePhase.OVER:
        return "done"
    if sequence.phase is not SequencePhase.PLAYING:
        return progress_text(sequence, now)
    if sequence.waiting:
        return "waiting for you"
    if _runs_up(sequence, now):
        return progress_text(sequence, now)
    return "paused" if sequence.playback.paused else "playing"


def _runs_up(sequence: SequenceSource, now: float) -> bool:
    start_at = sequence.cycle.start_at
    return start_at > 0 and sequence.playback.time(now) < start_at and sequence.playback.opening < start_at


def _next_key(sequence: SequenceSource, elapsed: float) -> NextKey | None:
    times = sequence.key_times
    index = bisect_right(times, elapsed + SAME_TIME)
    return NextKey(index + 1, times[index]) if index < len(times) else None


def _next_cue(sequence: SequenceSource) -> NextCue | None:
    coming = sequence.cues if sequence.phase is SequencePhase.PLAYING else sequence.all_cues
    cue = next((cue for cue in coming if math.isfinite(cue.at)), None)
    return None if cue is None else NextCue(cue.at, cue.name)
