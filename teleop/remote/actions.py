"""What a client's commands do on a rig in an operator's hands: each is a job, a press, or done at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

from teleop.config.profile import Profile
from teleop.core.axes import Axis, Limits, Motion, moves
from teleop.core.errors import TeleopError
from teleop.core.events import Action, Tick
from teleop.core.operator_input import Command
from teleop.manual.operator import Operator
from teleop.remote.asked import Asked, Refusal
from teleop.remote.desk import Desk
from teleop.remote.device_actions import DeviceActions, DueList
from teleop.remote.jobs import JobSource
from teleop.remote.key_actions import KeyActions
from teleop.remote.keys import HandKeys
from teleop.remote.made_jobs import JobMaker
from teleop.remote.move_actions import MoveActions
from teleop.remote.operator_actions import OperatorActions
from teleop.remote.permission import Permission
from teleop.remote.play_job import NotNowError, PlayJob
from teleop.remote.shoot_job import ShootJob
from teleop.remote.told import Told
from teleop.remote.track_job import TrackJob
from teleop.remote.way_actions import WayActions
from teleop.remote.works import Works


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
        self._limits, self._jobs, self._works = limits, jobs, works
        self.operator: Operator
        self.desk: Desk
        self._motion: Motion = {}
        self.commissions: Sequence[str] = ()  # devices that this run may end for
        self.commissioned = ""  # that for which it does
        self._due = DueList()
        motion, recall = (lambda: self._motion), profile.presets.recall
        self._may = may = Permission(jobs, lambda: self.operator.status)
        notify = lambda text: self.operator.notify(text)  # noqa: E731 - there is none yet
        self.moves = MoveActions(jobs, works, maker, self._due, keys, may, motion, notify)
        has_gimbal = any(sink.type == "gimbal" for sink in profile.sinks)
        self.devices = DeviceActions(jobs, told, self._due, lambda: self.rests, has_gimbal)
        ways = WayActions(limits, recall, jobs, may, motion)
        self.by_operator = OperatorActions(limits, recall, ways.go, motion)
        self._halted = False
        alone, camera = may.with_no_shoot, self.devices.camera
        self._do: Mapping[str, Callable[[Asked, float], None]] = {
            **ways.do,
            **self.moves.do,
            "record": alone(partial(camera, action=Action.RECORD)),
            "stop_recording": alone(partial(camera, action=Action.STOP)),
            "shutter": alone(partial(camera, action=Action.SHUTTER)),
            "track": alone(self._track),
            "follow": alone(self.devices.follow),
            "message": alone(self.devices.message),
            "commission": self._commission,
            **KeyActions(keys, motion).do,
            **self.by_operator.do,
        }

    # --- what the desk asks

    @property
    def rests(self) -> bool:
        return not moves(self._motion)

    def busy(self, session: str) -> bool:
        job = self._jobs.job
        own = job is not None and job.owner == session and not (isinstance(job, PlayJob | ShootJob) and job.paused)
        return own or self._works.planning or self._due.of(session) or self.moves.held.owner == session

    def do(self, asked: Asked, now: float) -> None:
        try:
            self._do[asked.command.do](asked, now)
        except (NotNowError, TeleopError) as error:
            raise Refusal(str(error)) from None

    def passing(self, now: float) -> None:
        self.moves.held.drop("control passes to another one")
        if self.moves.shoots.job is None:  # which goes on
            self._jobs.halt(now, "control passes to another one")

    def gone(self, sessions: Callable[[str], bool], now: float) -> None:
        """Also what each tick has to look at."""
        self._take_stop(now)
        if self.moves.held.owner and not self._keeps_control(self.moves.held.owner):
            self.moves.held.drop("control was lost before its start")
        self._works.deliver()
        self.moves.shoots.look()
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
        self.moves.passes.observe(tick)
        self._jobs.observe(tick)
        if not isinstance(self._jobs.job, PlayJob):
            self.moves.passes.end()

    def _take_stop(self, now: float) -> None:
        stopped = self.operator.status.stopped
        if stopped and not self._halted:
            self._jobs.halt(now, f"STOP by {self.operator.stopped_by}")
            self._works.drop("STOPPED")
            self.moves.held.drop(f"STOP by {self.operator.stopped_by}")
        self._halted = stopped

    # --- tracking, and the way to a commissioning

    def _track(self, asked: Asked, now: float) -> None:
        self._may.begin()
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

    def _commission(self, asked: Asked, now: float) -> None:  # noqa: ARG002 - every action gets it
        """The run ends as it does when it is quit: at rest, everything released."""
        if asked["device"] not in self.commissions:
            raise Refusal(f"no {asked['device']} can be commissioned from here")
        self._may.begin()
        if self._jobs.job is not None or self._works.planning or not self.rests:
            raise Refusal("wait until nothing moves")
        if self.operator.status.recording:
            raise Refusal("the camera records: stop that first")
        self.commissioned = asked["device"]
        self.desk.press(asked.command.name, Command.QUIT)
        asked.end()
