"""The door of a run by hand: opened with it, attached to its operator, and closed behind it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

from teleop.app.run import RunReport
from teleop.config.exchange import tracks
from teleop.config.operator_settings import EXPO
from teleop.config.presets import Presets
from teleop.config.profile import Profile
from teleop.config.sinks_section import CameraSection
from teleop.core.axes import Axis, Limits
from teleop.core.errors import LinkError
from teleop.core.events import Action, DeviceCommand, ShutterResult, Tick
from teleop.core.interfaces import Clock, Observer, Sink, Source
from teleop.core.invitation import Invitation
from teleop.core.operator_input import Command, Held, Input
from teleop.devices.rig import Rig
from teleop.devices.shutter import ShutterSink
from teleop.inputs.stick_shaping import shape
from teleop.manual.operator import Operator
from teleop.remote.actions import LiveActions
from teleop.remote.aims import Aims
from teleop.remote.desk import Desk
from teleop.remote.gateway_child import Gateway
from teleop.remote.jobs import JobSource
from teleop.remote.keys import HandKeys
from teleop.remote.live_shown import LiveShown
from teleop.remote.made_jobs import JobMaker
from teleop.remote.open_door import OpenDoor
from teleop.remote.shoot_recovery import ShootRecovery
from teleop.remote.state import Parts
from teleop.remote.stick import RemoteStick
from teleop.remote.told import Told
from teleop.remote.tracking import Tracking
from teleop.remote.works import Works


class RemoteHands:
    """`moves` is the folder of the moves that clients may name.

    `gateway` is what the gateway is told, beside where the door is; None for no gateway. The run may end so that one of
    the devices in `commissions` is commissioned. `note` is a line for everybody.
    """

    def __init__(self, moves: Path, gateway: Gateway | None, commissions: Sequence[str] = (), note: str = "") -> None:
        self._folder, self._gateway, self._commissions, self._note = moves, gateway, commissions, note
        self.desk: Desk
        self._read = False  # in this tick
        self._clock: Clock | None = None  # of the run that goes on, or was the last

    @property
    def invitation(self) -> Invitation | None:
        return None if self._gateway is None else self._gateway.invitation

    def open(self, stack: ExitStack, profile: Profile, limits: Mapping[Axis, Limits]) -> None:
        """Open the door, until the stack is left."""
        self._profile = profile
        self._limits = limits
        self._recovery = ShootRecovery(profile)
        self.door = OpenDoor(stack)
        stack.callback(self._leave)
        expo = EXPO if profile.sticks.expo is None else profile.sticks.expo
        moved = [axis for axis in limits if not axis.is_stick]
        stick = RemoteStick(moved, lambda value: shape(value, 0.0, expo))
        self._works, maker = Works(profile), JobMaker(limits, self._folder, self.door.address.sent)
        self._jobs, self._keys, self.told = JobSource(self._taken), HandKeys(limits), Told()
        self._actions = LiveActions(profile, limits, self._jobs, self._keys, self._works, maker, self.told)
        stack.callback(self._actions.moves.shoots.close)
        stack.callback(self._works.close)
        self.desk = Desk(self.door.socket, stick, self._notify, self._actions)
        self.desk.aims = Aims([each.smoothing for each in profile.exchange if tracks(each)])
        self._actions.commissions = self._commissions
        for actions in (self._actions, self._actions.moves, self._actions.devices, self._actions.by_operator):
            actions.desk = self.desk

    @property
    def commissioned(self) -> str:
        """The device that the run has ended for, "" for none."""
        return self._actions.commissioned

    @property
    def inputs(self) -> Sequence[Input]:
        """After all others: it is outranked by every local one."""
        return [_Hand(self.desk, self._mark)]

    @property
    def beneath(self) -> Source:
        return self._jobs

    def attach(self, stack: ExitStack, operator: Operator, presets: Presets, rig: Rig) -> tuple[Observer, Sink]:
        """To the operator of an open rig; from now on the gateway runs. What sees each tick, and the release."""
        again, self._clock = self._clock is not None, rig.clock
        if again and self._operator.stopped_by:  # a STOP that is not cleared outlasts a run
            self.desk.press(self._operator.stopped_by, Command.STOP)
        self._operator = self._actions.operator = self._actions.by_operator.operator = operator
        camera = rig.camera is not None
        self._actions.by_operator.presets, self._actions.devices.has_camera = presets, camera
        self._shutter = self._shutter_of(rig)
        self._actions.moves.shoots.has_camera = self._shutter is not None
        self._jobs.foresee = rig.foresee
        drone = rig.drone(list(self._limits))
        state = lambda: None if drone is None else drone.state(rig.clock.now())  # noqa: E731
        shown = LiveShown(operator, presets, self._jobs, self._keys, self._actions.moves.passes, state)
        facts = self._profile.name, self._limits, shown, rig.connections, self.desk, camera
        tracking = Tracking(self._profile, self.desk, self._jobs, self._actions, operator.notify)
        operator.track = tracking.by_hand
        parts = Parts(*facts, commissions=self._commissions, tracking=tracking.shown)
        self._publisher = self.door.publisher(parts, rig.clock)
        if again:
            self._jobs.again()
        elif self._gateway is not None:
            self.door.start(stack, self._gateway, self.desk, rig.clock, self._notify)
            self._works.start()
        greetings = self._gateway.greetings if self._gateway is not None else ()
        for line in (*greetings, *([self._note] if self._note and not again else [])):
            operator.notify(line)
        return self, self

    def _leave(self) -> None:
        """All runs are over."""
        self._jobs.end("the run has ended")
        if self._clock is not None:
            self._publisher.publish("over", self._clock.now())
            self.desk.flush()

    # --- a shoot outlasts a run that failed

    def goes_on(self, report: RunReport | LinkError) -> bool:
        job, reached = self._actions.moves.shoots.job, not isinstance(report, LinkError)
        if job is None or not self._recovery.goes_on(report, job):
            return False
        if reached:
            job.prepare()
        return True

    def wait(self, now: float) -> bool:
        if self._clock is not None:
            self._publisher.publish("waiting", now)
        why = self.desk.idle(now, "the rig is not reached: the shoot waits for it")
        if why:
            self._jobs.end(why)
        return not why

    # --- what becomes of commands

    def line(self, text: str) -> None:
        """A line that the operator gets."""
        self.told.line(text)

    def confirmed(self, command: DeviceCommand) -> None:
        self.told.confirm(command)

    def camera_answered(self, action: Action, done: bool) -> None:
        self.told.camera_answered(action, done)

    # --- observer and sink

    def observe(self, tick: Tick) -> None:
        self.door.look(self.desk, tick.time)
        self._actions.observe(tick)
        run, self._read = "running" if self._read else "stopping", False
        self._publisher.publish(run, tick.time, tick)
        self.desk.flush()

    def write(self, tick: Tick) -> None:
        if self._shutter is None:
            return
        self._shutter.write(tick)
        if self._shutter.holds and self._actions.moves.shoots.job is None:  # one that was ended before its end
            self._shutter.release(tick.time)

    def release(self, now: float) -> float | None:
        if (job := self._actions.moves.shoots.job) is None:
            self._jobs.end("the run has ended")
        else:
            job.leave(now)
        self._publisher.publish("releasing", now)
        self.desk.flush()
        return None if self._shutter is None else self._shutter.release(now)

    def _shutter_of(self, rig: Rig) -> ShutterSink | None:
        """Of the camera that the profile names, for shoots."""
        links = [section.link for section in rig.profile.sinks if isinstance(section, CameraSection)]
        return ShutterSink(rig.connections[links[0]], self._shot) if links else None

    def _shot(self, result: ShutterResult) -> None:
        if (job := self._actions.moves.shoots.job) is not None:
            job.on_result(result)

    def _mark(self) -> None:
        self._read = True

    def _taken(self) -> Any:
        return self._operator.taken

    def _notify(self, text: str) -> None:
        self._operator.notify(text)


class _Hand:
    """What clients press, and the stick of the one who has control, as one input; `mark` is called at each read."""

    def __init__(self, desk: Desk, mark: Callable[[], object]) -> None:
        self._desk, self._mark = desk, mark

    @property
    def name(self) -> str:
        return self._desk.stick.name

    def read(self, now: float) -> Held:
        self._mark()
        pressed = self._desk.read(now)
        return replace(self._desk.stick.read(now), presses=pressed.presses)
