"""What has to hold before a command of a client moves something."""

from __future__ import annotations

from collections.abc import Callable

from teleop.manual.status import OperatorStatus
from teleop.remote.asked import Asked, Refusal
from teleop.remote.jobs import JobSource
from teleop.remote.play_job import PlayJob
from teleop.remote.shoot_job import ShootJob


class Permission:
    """`status` is the operator's. All raise Refusal with what is in the way."""

    def __init__(self, jobs: JobSource, status: Callable[[], OperatorStatus]) -> None:
        self._jobs, self._status = jobs, status

    def move(self) -> None:
        """Anything at all."""
        status = self._status()
        if status.stopped:
            raise Refusal("STOP is not cleared")
        if status.deflections:
            raise Refusal("release the stick first")

    def begin(self) -> None:
        """Something else than what goes on."""
        self.move()
        if isinstance(self._jobs.job, PlayJob):
            raise Refusal(f"{self._jobs.job.title} is playing: abort it first")
        self._beside_a_shoot()

    def with_no_shoot(self, do: Callable[[Asked, float], None]) -> Callable[[Asked, float], None]:
        """The camera, and what the gimbal is set to, are the shoot's as long as there is one."""

        def checked(asked: Asked, now: float) -> None:
            self._beside_a_shoot()
            do(asked, now)

        return checked

    def _beside_a_shoot(self) -> None:
        if isinstance(self._jobs.job, ShootJob):
            raise Refusal(f"{self._jobs.job.title} is being shot: abort it first")
