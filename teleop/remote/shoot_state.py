"""A shoot as clients see it: plain values."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from teleop.core.clock import date
from teleop.timelapse.progress import Progress


def shoot_state(title: str, progress: Progress, now: float, halted: str) -> Mapping[str, Any]:
    """How far it is at `now`; `halted` is why its axes are held, "" where they are not."""
    left = math.inf if progress.by_hand else progress.left(now)
    return {
        "title": title,
        "frames_done": progress.shot,
        "frames": progress.slots.frames,
        "eta": None if math.isinf(left) else round(date() + left, 1),
        "missed": progress.missed,
        "paused": progress.pausing or bool(halted),
        "phase": progress.phase,
        "interval": None if progress.by_hand else round(progress.slots.interval(progress.frame), 3),
        "clip_s": progress.clip,
        "why": halted or progress.problem,
    }
