"""A move that plays, as clients see it: plain values."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from teleop.sequence.phases import SequencePhase
from teleop.sequence.progress import run_status
from teleop.sequence.source import SequenceSource

PHASES: Mapping[SequencePhase, str] = {
    SequencePhase.EASING: "easing",
    SequencePhase.PREROLL: "preroll",
    SequencePhase.ARMED: "armed",
    SequencePhase.PLAYING: "playing",
    SequencePhase.REJOINING: "rejoining",
    SequencePhase.RETURNING: "returning",
    SequencePhase.OVER: "resting",
}


def move_state(title: str, source: SequenceSource, now: float, halted: str, attended: bool) -> dict[str, Any]:
    """What it does at `now`; `halted` is why its axes are held away from its path, "" where they are not."""
    status, playback = run_status(source, now), source.playback
    phase = "waiting" if source.waiting else PHASES[source.phase]
    keys = len(source.key_times)
    return {
        "title": title,
        "phase": "paused" if halted or status.paused else phase,
        "at": None if status.elapsed is None else round(status.elapsed, 3),
        "duration": round(status.duration, 3),
        "speed": round(status.speed, 4),
        "key": status.key.number if status.key else keys,
        "keys": keys,
        "pass": status.number,
        "passes": None if math.isinf(status.passes) else int(status.passes),
        "attended": attended,
        "why": halted or playback.refusal,
        "max_speed": round(playback.at_most, 4),
    }
