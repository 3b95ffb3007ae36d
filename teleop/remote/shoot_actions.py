"""What a client's commands do to a shoot: begun, paused between frames, gone on with, ended, and told how it went."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence

from teleop.remote.asked import Asked, Refusal
from teleop.remote.device_actions import Due, DueList
from teleop.remote.jobs import Ended, JobSource
from teleop.remote.made_jobs import JobMaker
from teleop.remote.planning_process import PlanningProcess
from teleop.remote.shoot_job import ShootJob
from teleop.remote.works import Work, Works
from teleop.timelapse.troubles import troubles

BETWEEN = 3600.0  # s until a pause between two frames, or the end of a picture


class ShootActions:
    """`begin` takes a job that is ready, or refuses; `notify` takes lines for everybody."""

    def __init__(
        self,
        jobs: JobSource,
        works: Works,
        maker: JobMaker,
        due: DueList,
        begin: Callable[[Asked, ShootJob], bool],
        notify: Callable[[str], object],
    ) -> None:
        self._jobs, self._works, self._maker, self._due = jobs, works, maker, due
        self._begin, self._notify = begin, notify
        self.has_camera = False
        self._closing: list[threading.Thread] = []

    @property
    def job(self) -> ShootJob | None:
        """The shoot that goes on."""
        job = self._jobs.job
        return job if isinstance(job, ShootJob) else None

    def shoot(self, asked: Asked) -> None:
        if not self.has_camera:
            raise Refusal("this rig has no camera to shoot with")
        if asked.get("resume", False) and asked.get("restart", False):
            raise Refusal("resume or restart: not both", "invalid")
        maker = self._maker

        def ended(job: ShootJob) -> Ended:
            return lambda why: self._over(job, asked, why)

        def begin(job: ShootJob) -> None:
            if not self._begin(asked, job):
                self._close(job)

        def make(planner: PlanningProcess) -> ShootJob:
            self.close()  # the journal may be that of the shoot before
            return maker.shoot(asked, planner, ended)

        self._works.do(asked, Work(make, begin, lambda job: job.close()))

    def look(self) -> None:
        """Each tick: pass on what it has to tell."""
        job = self.job
        while job is not None and job.lines:
            self._notify(job.lines.pop(0))

    def pause(self, job: ShootJob, asked: Asked, now: float) -> None:
        if job.paused:
            raise Refusal("it is paused already")
        job.pause(now)
        self._until(job, asked, now)

    def resume(self, job: ShootJob, asked: Asked, now: float) -> None:
        job.resume()
        self._until(job, asked, now)

    def abort(self, job: ShootJob, asked: Asked, now: float) -> None:
        job.abort(now, f"aborted by {asked.command.name}")
        asked.accept()
        self._due.add(Due(asked, lambda _now: self.job is not job, now + BETWEEN, "it takes too long", lambda: ""))

    def _until(self, job: ShootJob, asked: Asked, now: float) -> None:
        asked.accept()
        done = lambda _now: self.job is not job or not job.changing()  # noqa: E731
        self._due.add(Due(asked, done, now + BETWEEN, "it takes too long", lambda: ""))

    def _over(self, job: ShootJob, asked: Asked, why: str) -> None:
        for line in (*job.lines, *report(job, why)):
            self._notify(line)
        self._close(job)
        asked.end(why)

    def _close(self, job: ShootJob) -> None:
        """Its journal waits for the disk: in a thread."""
        thread = threading.Thread(target=job.close, name="journal")
        thread.start()
        self._closing = [each for each in self._closing if each.is_alive()] + [thread]

    def close(self) -> None:
        """Wait for the journals."""
        for thread in self._closing:
            thread.join()


def report(job: ShootJob, why: str) -> Sequence[str]:
    """How a shoot went, in lines, that ended for `why`, "" for its own end."""
    progress = job.progress
    clip = f", {progress.clip:.2f} s of clip" if progress.clip is not None else ""
    title = f"{job.title}: {why}: " if why else f"{job.title}: "
    lines = [f"{title}{progress.shot} of {progress.slots.frames} frames shot{clip}", *troubles(progress)]
    scores = {axis: score for axis, score in job.tracking.scores.items() if axis in job.axes}
    errors = (f"{axis} {score.rms:.3f}, {score.peak:.3f} at most" for axis, score in scores.items())
    if found := "; ".join(errors):
        lines.append(f"errors on the way (rms): {found}")
    if why:
        lines.append(f'frame {progress.frame} is next: shoot it again with "resume": true ({job.journal.path.name})')
    return lines
