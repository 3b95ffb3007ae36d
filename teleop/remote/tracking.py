"""The tracking sources of a rig: what clients see of them, and the key of the terminal that follows one."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from teleop.config.exchange import tracks
from teleop.config.exchange.freed import FreeDSection
from teleop.config.exchange.opentrackio import OpenTrackIOSection
from teleop.config.profile import Profile
from teleop.door.messages import DoorCommand
from teleop.manual.operator import UNTRACKED
from teleop.remote.aims import ENDED
from teleop.remote.asked import Actions, Asked, Refusal
from teleop.remote.desk import Desk
from teleop.remote.jobs import JobSource
from teleop.remote.track_job import SILENT, TrackJob

NAME = "keys"  # who asks at the terminal


class Tracking:
    """The entries of the profile that a tracker sends to, counted from 1; `notify` takes lines for the operator."""

    def __init__(
        self, profile: Profile, desk: Desk, jobs: JobSource, actions: Actions, notify: Callable[[str], object]
    ) -> None:
        self._names: Sequence[str] = [
            f"{entry.type} at {entry.listen}"
            for entry in profile.exchange
            if tracks(entry) and isinstance(entry, FreeDSection | OpenTrackIOSection)
        ]
        self._desk, self._jobs, self._actions, self._notify = desk, jobs, actions, notify

    def shown(self, now: float) -> Mapping[str, Any] | None:
        """For the state; None in a rig that no tracker sends to. The age of a stream that is over is None."""
        if not self._names:
            return None
        job = self._jobs.job
        follows = job if isinstance(job, TrackJob) else None
        return {
            "sources": {str(number): self._source(number, name, now) for number, name in enumerate(self._names, 1)},
            "follows": None if follows is None else follows.source,
            "why": "" if follows is None else follows.trouble(now),
        }

    def _source(self, number: int, name: str, now: float) -> Mapping[str, Any]:
        stream = self._desk.aims.get(number)
        age = ENDED if stream is None else stream.age(now)
        return {"name": name, "age_ms": None if age >= ENDED else round(age * 1000, 1)}

    def by_hand(self, number: int, now: float) -> None:
        """Follow that source, or none with 0, asked for at the rig: it needs no control and no page."""
        if not self._names:
            self._notify(UNTRACKED)
        elif number:
            self._do("track", now, {"source": number, "attended": False})
        elif isinstance(self._jobs.job, TrackJob):
            self._do("abort", now, {})
        else:
            self._notify("track: no source is followed")

    def _do(self, name: str, now: float, fields: Mapping[str, Any]) -> None:
        asked = Asked(DoorCommand(name, 0, NAME, NAME, 0.0, fields), "", _Lines(self._notify))
        try:
            self._actions.do(asked, now)
        except Refusal as refusal:
            asked.refuse(refusal)


class _Lines:
    """Answers as lines: one who asks at the rig has no address."""

    def __init__(self, notify: Callable[[str], object]) -> None:
        self._notify = notify

    def answer(self, asked: Asked, message: Mapping[str, Any]) -> None:
        error = message.get("error", "")
        if asked.command.do != "track":
            return
        if not message.get("done"):
            self._notify(f"track: {error}" if error else f"source {asked['source']} is followed: a 0 ends it")
        elif error and not error.startswith(SILENT):  # which everybody is told
            self._notify(f"tracking ends: {error}")

    def action_over(self, asked: Asked) -> None: ...
