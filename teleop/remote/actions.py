"""What a client's commands do on a rig in an operator's hands: each is a job, a press, or done at once."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial

from teleop.config.profile import Profile
from teleop.core.axes import Axis, Limits, Motion, moves
from teleop.core.errors import TeleopError
from teleop.core.events import Action, Tick
from teleop.core.operator_input import Command
from teleop.manual.operator import CENTERED, Operator
from teleop.manual.recall import at_rest, reachable
from teleop.planner.chasing import Reference
from teleop.planner.go_motion import ExposureRuns
from teleop.planner.shortest import shortest_seconds
from teleop.remote.asked import Asked, Refusal
from teleop.remote.desk import Desk
from teleop.remote.device_actions import DeviceActions, Due, DueList
from teleop.remote.go_motion_job import GoMotionJob
from teleop.remote.held_move import HeldMove
from teleop.remote.jobs import JobSource, WayJob
from teleop.remote.key_actions import KeyActions
from teleop.remote.keys import HandKeys
from teleop.remote.made_jobs import JobMaker
from teleop.remote.operator_actions import OperatorActions
from teleop.remote.pass_errors import ShownPasses
from teleop.remote.play_job import NotNowError, PlayJob
from teleop.remote.shoot_actions import ShootActions
from teleop.remote.shoot_job import ShootJob
from teleop.remote.told import Told
from teleop.remote.track_job import TrackJob
from teleop.remote.works import Work, Works

CLOCK = 2.0  # s by which the clock of a chase may have been read before
JOG_TIME = 0.5  # s that a jog takes at least, unless it says otherwise
WAY_TIME = 600.0  # s for a way along the path of a move
SLACK = 1e-6


class LiveActions:
    """The commands of a rig in an operator's hands; `works` plans moves beside the control thread."""

    def __init__(
        self,
        profile: Profile,
        limits: Mapping[Axis, Limits],
        jobs: JobSource,
        keys: HandKeys,
        works: Works,
        maker: JobMaker,
        told: Told,
    ) -> None:
        self._profile, self._limits, self._jobs, self.keys, self._works = profile, limits, jobs, keys, works
        self._maker = maker
        self.operator: Operator
        self.desk: Desk
        self.passes = ShownPasses()
        self._motion: Motion = {}
        self.commissions: Sequence[str] = ()  # devices that this run may end for
        self.commissioned = ""  # that for which it does
        self._due = DueList()
        self._held = HeldMove()
        has_gimbal = any(sink.type == "gimbal" for sink in profile.sinks)
        self.devices = DeviceActions(jobs, told, self._due, lambda: self.rests, has_gimbal)
        self.shoots = ShootActions(jobs, works, maker, self._due, self._begin, lambda text: self.operator.notify(text))
        self.by_operator = OperatorActions(limits, profile.presets.recall, self._go, lambda: self._motion)
        self._halted = False
        self._do: Mapping[str, Callable[[Asked, float], None]] = {
            "goto": lambda asked, _now: self._go("goto", asked, dict(asked["axes"]), asked.get("seconds")),
            "go_motion": self._go_motion,
            "jog": self._jog,
            "focus": lambda asked, _now: self._go("focus", asked, {Axis.FOCUS: asked["to"]}, asked.get("seconds")),
            "recenter": self._recenter,
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
            "abort": self._abort,
            "chase": self._chase,
            "record": self._with_no_shoot(partial(self.devices.camera, action=Action.RECORD)),
            "stop_recording": self._with_no_shoot(partial(self.devices.camera, action=Action.STOP)),
            "shutter": self._with_no_shoot(partial(self.devices.camera, action=Action.SHUTTER)),
            "commission": self._commission,
            "track": self._with_no_shoot(self._track),
            "follow": self._with_no_shoot(self.devices.follow),
            "message": self._with_no_shoot(self.devices.message),
            **KeyActions(keys, lambda: self._motion).do,
            **self.by_operator.do,
        }

    # --- what the desk asks

    @property
    def rests(self) -> bool:
        return not moves(self._motion)

    def busy(self, session: str) -> bool:
        job = self._jobs.job
        own = job is not None and job.owner == session and not (isinstance(job, PlayJob | ShootJob) and job.paused)
        return own or self._works.planning or self._due.of(session) or self._held.owner == session

    def do(self, asked: Asked, now: float) -> None:
        try:
            self._do[asked.command.do](asked, now)
        except (NotNowError, TeleopError) as error:
            raise Refusal(str(error)) from None

    def passing(self, now: float) -> None:
        self._held.drop("control passes to another one")
        if self.shoots.job is None:  # which goes on
            self._jobs.halt(now, "control passes to another one")

    def gone(self, sessions: Callable[[str], bool], now: float) -> None:
        """Also what each tick has to look at."""
        self._take_stop(now)
        if self._held.owner and not self._keeps_control(self._held.owner):
            self._held.drop("control was lost before its start")
        self._works.deliver()
        self.shoots.look()
        self._due.look(now)
        job = self._jobs.job
        if isinstance(job, TrackJob) and job.attended and sessions(job.owner):
            self._jobs.end("its console is gone")
            self.operator.notify("tracking ends: its console is gone")
        if isinstance(job, PlayJob) and job.attended and not job.left and not job.paused and sessions(job.owner):
            job.left = True
            job.pause(now, "its console is gone")
            self.operator.notify(f"{job.title} pauses: its console is gone")

    def _keeps_control(self, session: str) -> bool:
        return self.desk.control.holds(session) and not self.desk.control.leaving

    def observe(self, tick: Tick) -> None:
        self._motion = tick.motion
        self.passes.observe(tick)
        self._jobs.observe(tick)
        if not isinstance(self._jobs.job, PlayJob):
            self.passes.end()

    def _take_stop(self, now: float) -> None:
        stopped = self.operator.status.stopped
        if stopped and not self._halted:
            self._jobs.halt(now, f"STOP by {self.operator.stopped_by}")
            self._works.drop("STOPPED")
            self._held.drop(f"STOP by {self.operator.stopped_by}")
        self._halted = stopped

    # --- ways

    def _may_move(self) -> None:
        if self.operator.status.stopped:
            raise Refusal("STOP is not cleared")
        if self.operator.status.deflections:
            raise Refusal("release the stick first")

    def _may_begin(self) -> None:
        self._may_move()
        if isinstance(self._jobs.job, PlayJob):
            raise Refusal(f"{self._jobs.job.title} is playing: abort it first")
        self._refuse_beside_a_shoot()

    def _refuse_beside_a_shoot(self) -> None:
        if self.shoots.job is not None:
            raise Refusal(f"{self.shoots.job.title} is being shot: abort it first")

    def _with_no_shoot(self, do: Callable[[Asked, float], None]) -> Callable[[Asked, float], None]:
        """The camera, and what the gimbal is set to, are the shoot's as long as there is one."""

        def checked(asked: Asked, now: float) -> None:
            self._refuse_beside_a_shoot()
            do(asked, now)

        return checked

    def _go(self, title: str, asked: Asked, targets: dict[Axis, float], seconds: float | None) -> None:
        self._may_begin()
        where = {axis: self._place(axis, to) for axis, to in targets.items()}
        if not where:
            raise Refusal(f"{title} has no axis of this rig")
        if asked.get("seconds") and not asked.get("stretch", False):
            self._refuse_haste(title, where, asked["seconds"])
        speeds = asked.get("speeds")
        if speeds and seconds:
            raise Refusal(f"{title}: give seconds or speeds, not both")
        asked.accept()
        self._jobs.begin(WayJob(title, asked.command.session, where, seconds, asked.end, speeds))

    def _go_motion(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        self._may_begin()
        before, places, after = asked["before"], asked["axes"], asked["after"]
        if not before.keys() == places.keys() == after.keys():
            raise Refusal("go-motion: axes, before and after must name the same axes")
        for axis, place in places.items():
            self._place(axis, place)
        shape = asked["blur"], asked["exposure"]
        runs = {
            axis: ExposureRuns.once(before[axis], places[axis], after[axis], *shape, self._limits[axis])
            for axis in places
        }
        job = GoMotionJob(asked.command.session, runs, asked.end)
        job.check_start(self._motion)
        asked.accept()
        self._jobs.begin(job)

    def _refuse_haste(self, title: str, where: Mapping[Axis, float], seconds: float) -> None:
        """Raises Refusal where the limits do not allow it in the time that was asked for."""
        least = shortest_seconds(self._motion, where, self._limits)
        if seconds < least - SLACK:
            least = math.ceil(least * 100) / 100  # what is named is long enough
            raise Refusal(f"{title} in {seconds:g} s is too short: the limits of this rig need {least:.2f} s")

    def _place(self, axis: Axis, to: float) -> float:
        """Where an axis goes that is sent to `to`; raises Refusal for one that cannot."""
        if axis not in self._limits or axis.is_stick:
            raise Refusal(f"{axis} is not an axis of this rig that can be sent to a place")
        limits = self._limits[axis]
        if not limits.minimum - SLACK <= to <= limits.maximum + SLACK:
            raise Refusal(f"{axis}: {to:g} is outside the soft limits ({limits.minimum:g}..{limits.maximum:g})")
        return reachable(to, limits, self._motion[axis].position)

    def _jog(self, asked: Asked, now: float) -> None:  # noqa: ARG002 - every action gets it
        axis, job = asked["axis"], self._jobs.job
        if axis not in self._limits or axis.is_stick:
            raise Refusal(f"{axis} is not an axis of this rig that can be jogged")
        limits = self._limits[axis]
        if isinstance(job, WayJob) and job.title == "jog" and set(job.axes) == {axis}:
            start = job.targets[axis]
        else:
            start = at_rest(self._motion[axis], limits).position
        target = min(max(start + asked["by"], limits.minimum), limits.maximum)
        if target == start:
            raise Refusal(f"{axis} is at its soft limit")
        self._may_begin()
        asked.accept()
        seconds = asked.get("within", JOG_TIME)
        self._jobs.begin(WayJob("jog", asked.command.session, {axis: target}, seconds, asked.end))

    def _recenter(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        targets = {axis: 0.0 for axis in CENTERED if axis in self._limits}
        self._go("recenter", asked, targets, asked.get("seconds", self._profile.presets.recall))

    def _track(self, asked: Asked, now: float) -> None:
        self._may_begin()
        source = asked.get("source", 1)
        stream = self.desk.aims.get(source)
        if stream is None or not stream.fresh(now):
            raise Refusal(f"nothing arrives from tracking source {source}")
        missing = [axis.value for axis in stream.axes if axis not in self._limits]
        if missing:
            raise Refusal(f"track: this run has no {' and '.join(missing)}")
        attended = asked.get("attended", True)
        asked.accept()
        self._jobs.begin(
            TrackJob(source, asked.command.session, stream, self._limits, attended, self.operator.notify, asked.end)
        )

    # --- moves

    def _play(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        self._may_plan()
        by_hand, maker = asked["move"] == "keys", self._maker
        if by_hand and len(self.keys.keys) < 2:
            raise Refusal("set at least two keys first")
        what = self.keys.content() if by_hand else asked["move"]
        self._works.do(
            asked, Work(lambda planner: maker.play(asked, what, planner), lambda job: self._begin(asked, job))
        )

    def _shoot(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        self._may_plan()
        self.shoots.shoot(asked)

    def _may_plan(self) -> None:
        self._may_begin()
        if self._works.planning:
            raise Refusal("another move is being planned")

    def _begin(self, asked: Asked, job: PlayJob | ShootJob) -> bool:
        """The move is planned: play it, if the one who asked still may; whether it begins."""
        try:
            self.desk.authorize(asked, self.desk.polled_at)
            self._may_begin()
        except Refusal as refusal:
            asked.refuse(refusal)
            return False
        if isinstance(job, PlayJob) and asked.get("held", False):
            self._held.hold(asked, job, self._motion)
            return False
        asked.accept()
        self._play_on(job)
        return True

    def _play_on(self, job: PlayJob | ShootJob) -> None:
        self._jobs.begin(job)
        if isinstance(job, PlayJob):
            self.passes.watch(job.title, job.source, job.axes, lambda: job.halted)

    def _start(self, asked: Asked, now: float) -> None:
        self._may_begin()
        if not self.rests:
            raise Refusal("the axes still move: try again")
        self._play_on(self._held.start(asked.command.session, asked["at"], now, self._motion))
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
        self._may_move()
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
        if self._held.owner:
            self._held.drop(f"aborted by {asked.command.name}")
        elif self._jobs.job is None:
            raise Refusal("nothing moves that could be aborted")
        self._jobs.end(f"aborted by {asked.command.name}")
        asked.end()

    def _commission(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        """The run ends as it does when it is quit: at rest, everything released."""
        if asked["device"] not in self.commissions:
            raise Refusal(f"no {asked['device']} can be commissioned from here")
        self._may_begin()
        if self._jobs.job is not None or self._works.planning or not self.rests:
            raise Refusal("wait until nothing moves")
        if self.operator.status.recording:
            raise Refusal("the camera records: stop that first")
        self.commissioned = asked["device"]
        self.desk.press(asked.command.name, Command.QUIT)
        asked.end()
