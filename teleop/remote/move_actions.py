"""What a client's commands do to moves and shoots: planned, begun, paused, gone on with, steered, and ended."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from teleop.core.axes import Motion, moves
from teleop.planner.chasing import Reference
from teleop.remote.asked import Asked, Refusal
from teleop.remote.desk import Desk
from teleop.remote.device_actions import Due, DueList
from teleop.remote.held_move import HeldMove
from teleop.remote.jobs import JobSource
from teleop.remote.keys import HandKeys
from teleop.remote.made_jobs import JobMaker
from teleop.remote.pass_errors import ShownPasses
from teleop.remote.permission import Permission
from teleop.remote.play_job import PlayJob
from teleop.remote.shoot_actions import ShootActions
from teleop.remote.shoot_job import ShootJob
from teleop.remote.works import Work, Works

CLOCK = 2.0  # s by which the clock of a chase may have been read before
WAY_TIME = 600.0  # s for a way along the path of a move


class MoveActions:
    """`works` plans beside the control thread. `motion` is where the axes are, `notify` takes lines for everybody."""

    def __init__(
        self,
        jobs: JobSource,
        works: Works,
        maker: JobMaker,
        due: DueList,
        keys: HandKeys,
        may: Permission,
        motion: Callable[[], Motion],
        notify: Callable[[str], object],
    ) -> None:
        self._jobs, self._works, self._maker, self._due, self._keys = jobs, works, maker, due, keys
        self._may, self._motion = may, motion
        self.desk: Desk
        self.held, self.passes = HeldMove(), ShownPasses()
        self.shoots = ShootActions(jobs, works, maker, due, self._begin, notify)
        self.do: Mapping[str, Callable[[Asked, float], None]] = {
            "play": self._play,
            "start": self._start,
            "shoot": self._shoot,
            "pause": self._pause,
            "resume": self._resume,
            "speed": lambda asked, now: self._transport(asked, now, lambda job: job.speed(asked["share"], now)),
            "seek": lambda asked, now: self._transport(asked, now, lambda job: job.seek(asked["at"], now)),
            "next_key": lambda asked, now: self._transport(asked, now, lambda job: job.step(1, now)),
            "previous_key": lambda asked, now: self._transport(asked, now, lambda job: job.step(-1, now)),
            "to_start": lambda asked, now: self._transport(asked, now, lambda job: job.to_start(now)),
            "chase": self._chase,
            "abort": self._abort,
        }

    def _play(self, asked: Asked, now: float) -> None:  # noqa: ARG002 - every action gets it
        self._may_plan()
        by_hand, maker = asked["move"] == "keys", self._maker
        if by_hand and len(self._keys.keys) < 2:
            raise Refusal("set at least two keys first")
        what = self._keys.content() if by_hand else asked["move"]
        self._works.do(
            asked, Work(lambda planner: maker.play(asked, what, planner), lambda job: self._begin(asked, job))
        )

    def _shoot(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        self._may_plan()
        self.shoots.shoot(asked)

    def _may_plan(self) -> None:
        self._may.begin()
        if self._works.planning:
            raise Refusal("another move is being planned")

    def _begin(self, asked: Asked, job: PlayJob | ShootJob) -> bool:
        """The move is planned: play it, if the one who asked still may; whether it begins."""
        try:
            self.desk.authorize(asked, self.desk.polled_at)
            self._may.begin()
        except Refusal as refusal:
            asked.refuse(refusal)
            return False
        if isinstance(job, PlayJob) and asked.get("held", False):
            self.held.hold(asked, job, self._motion())
            return False
        asked.accept()
        self._play_on(job)
        return True

    def _play_on(self, job: PlayJob | ShootJob) -> None:
        self._jobs.begin(job)
        if isinstance(job, PlayJob):
            self.passes.watch(job.title, job.source, job.axes, lambda: job.halted)

    def _start(self, asked: Asked, now: float) -> None:
        self._may.begin()
        if moves(self._motion()):
            raise Refusal("the axes still move: try again")
        self._play_on(self.held.start(asked.command.session, asked["at"], now, self._motion()))
        asked.end()

    def _transport(self, asked: Asked, now: float, does: Callable[[PlayJob], object]) -> None:
        """Done once the change of speed, or the way along the path, is."""
        job = self._jobs.job
        if not isinstance(job, PlayJob):
            raise Refusal("no move is playing")
        does(job)
        asked.accept()
        done = lambda now: self._jobs.job is not job or not job.changing(now)  # noqa: E731
        self._due.add(Due(asked, done, now + WAY_TIME, "it takes too long", lambda: job.source.playback.refusal))

    def _pause(self, asked: Asked, now: float) -> None:
        if self.shoots.job is not None:
            self.shoots.pause(self.shoots.job, asked, now)
        else:
            self._transport(asked, now, lambda job: job.pause(now))

    def _resume(self, asked: Asked, now: float) -> None:
        self._may.move()
        if self.shoots.job is not None:
            self.shoots.resume(self.shoots.job, asked, now)
            return
        job = self._jobs.job
        if isinstance(job, PlayJob):
            job.owner = asked.command.session
        self._transport(asked, now, lambda job: job.resume(now))

    def _chase(self, asked: Asked, now: float) -> None:
        """The place that the move is to have at the time of the command, by this computer's clock."""
        job = self._jobs.job
        if not isinstance(job, PlayJob):
            raise Refusal("no move is playing")
        if abs(now - asked.command.time / 1000) > CLOCK:
            raise Refusal("chase: its time is not of this computer's clock")
        reference = Reference(asked["at"], asked.command.time / 1000, asked.get("rate", 1.0))
        job.chase(reference, asked.get("free", False), now)
        asked.end()

    def _abort(self, asked: Asked, now: float) -> None:
        if self.shoots.job is not None:
            self.shoots.abort(self.shoots.job, asked, now)
            return
        if self.held.owner:
            self.held.drop(f"aborted by {asked.command.name}")
        elif self._jobs.job is None:
            raise Refusal("nothing moves that could be aborted")
        self._jobs.end(f"aborted by {asked.command.name}")
        asked.end()
