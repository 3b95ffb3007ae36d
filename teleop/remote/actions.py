"""What a client's commands do on a rig in an operator's hands: each is a job, a press, or done at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from teleop.config.presets import Presets
from teleop.config.profile import Profile
from teleop.core.axes import Axis, Limits, Motion, moves
from teleop.core.errors import TeleopError
from teleop.core.events import Action, Tick
from teleop.core.operator_input import Command
from teleop.manual.operator import CENTERED, Operator
from teleop.manual.recall import at_rest, reachable
from teleop.planner.chasing import Reference
from teleop.remote.asked import Asked, Refusal
from teleop.remote.desk import Desk
from teleop.remote.device_actions import DeviceActions, Due, DueList
from teleop.remote.jobs import JobSource, WayJob
from teleop.remote.keys import MOST as MOST_KEYS
from teleop.remote.keys import HandKeys
from teleop.remote.play_job import NotNowError, PlayJob
from teleop.remote.told import Told
from teleop.remote.works import Works

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
        told: Told,
    ) -> None:
        self._profile, self._limits, self._jobs, self.keys, self._works = profile, limits, jobs, keys, works
        self.operator: Operator
        self.presets: Presets
        self.desk: Desk
        self._motion: Motion = {}
        self._due = DueList()
        has_gimbal = any(sink.type == "gimbal" for sink in profile.sinks)
        self.devices = DeviceActions(jobs, told, self._due, lambda: self.rests, has_gimbal)
        self._halted = False
        self._do: Mapping[str, Callable[[Asked, float], None]] = {
            "goto": lambda asked, _now: self._go("goto", asked, dict(asked["axes"]), asked.get("seconds")),
            "jog": self._jog,
            "focus": lambda asked, _now: self._go("focus", asked, {Axis.FOCUS: asked["to"]}, asked.get("seconds")),
            "recenter": self._recenter,
            "preset_recall": self._recall,
            "preset_store": self._store,
            "preset_delete": self._delete,
            "set_key": self._set_key,
            "delete_key": self._delete_key,
            "clear_keys": self._clear_keys,
            "play": self._play,
            "pause": lambda asked, now: self._transport(asked, now, lambda job: job.pause(now)),
            "resume": self._resume,
            "speed": lambda asked, now: self._transport(asked, now, lambda job: job.speed(asked["share"], now)),
            "seek": lambda asked, now: self._transport(asked, now, lambda job: job.seek(asked["at"], now)),
            "next_key": lambda asked, now: self._transport(asked, now, lambda job: job.step(1, now)),
            "previous_key": lambda asked, now: self._transport(asked, now, lambda job: job.step(-1, now)),
            "to_start": lambda asked, now: self._transport(asked, now, lambda job: job.to_start(now)),
            "abort": self._abort,
            "chase": self._chase,
            "record": lambda asked, now: self.devices.camera(asked, now, Action.RECORD),
            "stop_recording": lambda asked, now: self.devices.camera(asked, now, Action.STOP),
            "shutter": lambda asked, now: self.devices.camera(asked, now, Action.SHUTTER),
            "range": self._range,
            "follow": self.devices.follow,
            "message": self.devices.message,
        }

    # --- what the desk asks

    @property
    def rests(self) -> bool:
        return not moves(self._motion)

    def busy(self, session: str) -> bool:
        job = self._jobs.job
        own = job is not None and job.owner == session and not (isinstance(job, PlayJob) and job.paused)
        return own or self._works.planning or self._due.of(session)

    def do(self, asked: Asked, now: float) -> None:
        action = self._do.get(asked.command.do)
        if action is None:
            raise Refusal(f"{asked.command.do}: a shoot is a run of its own: teleop play FILE --console")
        try:
            action(asked, now)
        except (NotNowError, TeleopError) as error:
            raise Refusal(str(error)) from None

    def passing(self, now: float) -> None:
        if self._jobs.job is not None:
            self._jobs.halt(now, "control passes to another one")

    def gone(self, sessions: Callable[[str], bool], now: float) -> None:
        """Also what each tick has to look at."""
        self._take_stop(now)
        self._works.deliver(now)
        self._due.look(now)
        job = self._jobs.job
        if isinstance(job, PlayJob) and job.attended and not job.left and not job.paused and sessions(job.owner):
            job.left = True
            job.pause(now, "its console is gone")
            self.operator.notify(f"{job.title} pauses: its console is gone")

    def observe(self, tick: Tick) -> None:
        self._motion = tick.motion
        self._jobs.observe(tick)

    def _take_stop(self, now: float) -> None:
        stopped = self.operator.status.stopped
        if stopped and not self._halted:
            self._jobs.halt(now, f"STOP by {self.operator.stopped_by}")
            self._works.drop("STOPPED")
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

    def _go(self, title: str, asked: Asked, targets: dict[Axis, float], seconds: float | None) -> None:
        self._may_begin()
        where = {axis: self._place(axis, to) for axis, to in targets.items()}
        if not where:
            raise Refusal(f"{title} has no axis of this rig")
        asked.accept()
        self._jobs.begin(WayJob(title, asked.command.session, where, seconds, asked.end))

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

    # --- presets and keys

    def _recall(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        preset = self.presets.get(asked["number"])
        if preset is None:
            raise Refusal(f"there is no preset {asked['number']} yet")
        known = {axis: to for axis, to in preset.positions.items() if axis in self._limits and not axis.is_stick}
        cut = {axis: min(max(to, of.minimum), of.maximum) for axis, to in known.items() if (of := self._limits[axis])}
        self._go(f"preset {asked['number']}", asked, cut, asked.get("seconds", self._profile.presets.recall))

    def _store(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        where = {axis: state.position for axis, state in self._motion.items() if not axis.is_stick}
        self.presets.store(asked["number"], where, asked.get("name"))
        self.operator.notify(f"preset {asked['number']} stored")
        asked.end()

    def _delete(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        if not self.presets.delete(asked["number"]):
            raise Refusal(f"there is no preset {asked['number']}")
        self.operator.notify(f"preset {asked['number']} deleted")
        asked.end()

    def _set_key(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        if len(self.keys.keys) >= MOST_KEYS:
            raise Refusal(f"there are {MOST_KEYS} keys already")
        self.keys.set(self._motion)
        asked.end()

    def _delete_key(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        if not self.keys.delete(asked["number"]):
            raise Refusal(f"there is no key {asked['number']}")
        asked.end()

    def _clear_keys(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        self.keys.clear()
        asked.end()

    # --- moves

    def _play(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        self._may_begin()
        if self._works.planning:
            raise Refusal("another move is being planned")
        by_hand = asked["move"] == "keys"
        if by_hand and len(self.keys.keys) < 2:
            raise Refusal("set at least two keys first")
        asked.planning()
        self._works.plan(asked, self.keys.content() if by_hand else asked["move"], self._begin)

    def _begin(self, asked: Asked, job: PlayJob) -> None:
        """The move is planned: play it, if the one who asked still may."""
        try:
            if not self.desk.control.holds(asked.command.session):
                raise Refusal("control was lost while the move was planned")
            self._may_move()
            if missing := [axis.value for axis in job.axes if axis not in self._limits]:
                raise Refusal(f"{', '.join(missing)}: not in this run")
        except Refusal as refusal:
            asked.refuse(refusal)
            return
        asked.accept()
        self._jobs.begin(job)

    def _transport(self, asked: Asked, now: float, does: Callable[[PlayJob], object]) -> None:
        """Done once the change of speed, or the way along the path, is."""
        job = self._jobs.job
        if not isinstance(job, PlayJob):
            raise Refusal("no move is playing")
        does(job)
        asked.accept()
        done = lambda now: self._jobs.job is not job or not job.changing(now)  # noqa: E731
        self._due.add(Due(asked, done, now + WAY_TIME, "it takes too long", lambda: job.source.playback.refusal))

    def _resume(self, asked: Asked, now: float) -> None:
        self._may_move()
        job = self._jobs.job
        if isinstance(job, PlayJob):
            job.owner = asked.command.session
        self._transport(asked, now, lambda job: job.resume(now))

    def _chase(self, asked: Asked, now: float) -> None:
        """The place that the move is to have at the time of the command, by this computer's clock."""
        job = self._jobs.job
        if not isinstance(job, PlayJob):
            raise Refusal("no move is playing")
        reference = Reference(asked["at"], asked.command.time / 1000, asked.get("rate", 1.0))
        job.chase(reference, asked.get("free", False), now)
        asked.end()

    def _abort(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        if self._jobs.job is None:
            raise Refusal("nothing moves that could be aborted")
        self._jobs.end(f"aborted by {asked.command.name}")
        asked.end()

    def _range(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        ranges = len(self.operator.status.ranges)
        if asked["number"] > ranges:
            raise Refusal(f"there are {ranges} speed ranges")
        self.desk.press(asked.command.name, Command.RANGE, asked["number"])
        asked.end()
