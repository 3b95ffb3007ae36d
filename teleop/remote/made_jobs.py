"""Jobs made of what a client has asked for, in the thread that waits for the plan; the control thread begins them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from teleop.core.axes import Axis, Limits
from teleop.core.errors import TeleopError
from teleop.remote.asked import Asked
from teleop.remote.follower import Follower
from teleop.remote.jobs import Ended
from teleop.remote.moves import Sent, move_file
from teleop.remote.planning_process import PlanningProcess
from teleop.remote.play_job import PlayJob
from teleop.remote.shoot_job import ShootJob
from teleop.sequence.common_start import CommonStart
from teleop.sequence.cycle import Cycle
from teleop.sequence.source import SequenceSource
from teleop.timelapse.journal import ENDING, Shoot, open_journal


class JobMaker:
    """`folder` has the moves that clients may name, and the journals of shoots. All raise TeleopError.

    `sent` is the folder of a move that came as text, by its number.
    """

    def __init__(self, limits: Mapping[Axis, Limits], folder: Path, sent: Callable[[int], Path]) -> None:
        self._limits, self._folder, self._sent = limits, folder, sent

    def play(self, asked: Asked, what: str | Mapping[str, Any], planner: PlanningProcess) -> PlayJob:
        """A move of that name, one that was sent, or one with that content."""
        if (number := asked.get("sent")) is not None:
            compiled = planner.plan(Sent(self._sent(number) / f"{what}.yaml"))
        else:
            compiled = planner.plan(move_file(what, self._folder) if isinstance(what, str) else what)
        passes = float("inf") if asked.get("loop", False) else asked.get("passes", 1)
        preroll = asked.get("preroll", compiled.preroll)
        held = asked.get("held", False)
        follower = Follower() if asked.get("chase", False) and not held else None
        trigger = CommonStart() if held else follower
        cycle = Cycle(0.0 if held else preroll, passes=passes, back_to_one=compiled.back_to_one, trigger=trigger)
        self._refuse_missing(compiled.title, compiled.move.tracks)
        source = SequenceSource(compiled, self._limits, asked.get("speed", 1.0), cycle=cycle)
        attended = asked.get("attended", True)
        return PlayJob(compiled.title, asked.command.session, source, attended, asked.end, follower)

    def shoot(self, asked: Asked, planner: PlanningProcess, ended: Callable[[ShootJob], Ended]) -> ShootJob:
        """The timelapse of the name that is asked for, from its first frame or from where its journal says."""
        file = Path(move_file(asked["move"], self._folder))
        timelapse = planner.timelapse(str(file))
        self._refuse_missing(timelapse.title, timelapse.limits)
        resume, restart = asked.get("resume", False), asked.get("restart", False)
        path, belongs = self._folder / (file.stem + ENDING), Shoot(file.name, timelapse.identity, timelapse.frames)
        with ExitStack() as stack:
            try:
                journal = stack.enter_context(open_journal(path, belongs, resume=resume, restart=restart))
            except TeleopError as error:
                raise TeleopError(_without_options(str(error), path)) from None
            if journal.next >= timelapse.frames:
                journal.finish()
                raise TeleopError(f"{path.name}: every frame is shot: nothing is left to resume")
            job = ShootJob(timelapse, asked.command.session, journal)
            job.ended, job.close = ended(job), stack.pop_all().close
            return job

    def _refuse_missing(self, title: str, axes: Collection[Axis]) -> None:
        if missing := [axis for axis in axes if axis not in self._limits]:
            raise TeleopError(f"{title}: this run has no {', '.join(missing)}")


def _without_options(text: str, path: Path) -> str:
    """What the journal says, as a client has to say it: fields, and names instead of paths."""
    for option in ("resume", "restart"):
        text = text.replace(f"--{option}: ", "").replace(f"--{option}", f'"{option}": true')
    return text.replace(str(path), path.name).replace(f" in {path.absolute().parent}", "")
