"""Whether a shoot that a client has begun goes on after a run of the rig that failed: as that of `teleop play` does."""

from __future__ import annotations

import math

from teleop.app.run import RunReport
from teleop.app.shoot_runner import LONGEST_WAIT, RETRY, passes_by_itself
from teleop.config.profile import Profile
from teleop.core.errors import LinkError
from teleop.core.run_state import Result
from teleop.remote.shoot_job import ShootJob


class ShootRecovery:
    """Of one shoot after the other."""

    def __init__(self, profile: Profile) -> None:
        self._profile = profile
        self._shot = self._fruitless = 0
        self._waited = 0.0  # s in a row
        self._waiting = False

    def goes_on(self, report: RunReport | LinkError, job: ShootJob) -> bool:
        """After this run, or this try to reach the rig."""
        if isinstance(report, LinkError):
            self._waited += RETRY
            return self._waited <= LONGEST_WAIT
        self._fruitless = 0 if job.progress.shot > self._shot else self._fruitless + 1
        self._shot = job.progress.shot
        reached = job.reached < math.inf
        if report.result is not Result.FAILED:
            return False
        if not (self._waiting and not reached) and not passes_by_itself(
            report.faults, self._profile.timelapse.wait_for_link and reached, self._fruitless
        ):
            return False
        self._waiting = isinstance(report.faults[0], LinkError) or not reached
        self._waited = self._waited + RETRY if self._waiting and not reached else 0.0
        if reached:
            line = "waiting for the link, then going" if self._waiting else "going"
            job.lines.append(f"{report.reasons[0]}: {line} on at frame {job.journal.next}")
        return self._waited <= LONGEST_WAIT
