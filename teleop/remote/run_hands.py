"""The door of a run that moves by itself, a sequence or a shoot: all see it and may stop it, the holder pauses it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from types import MappingProxyType
from typing import Any

from teleop.app.beside import Running
from teleop.config.profile import Profile
from teleop.core.axes import Axis, Limits, Motion
from teleop.core.events import Action, Tick
from teleop.core.interfaces import Clock, Observer
from teleop.core.invitation import Invitation
from teleop.core.operator_input import Command, Input
from teleop.manual.status import InputStatus, MessageLog, OperatorStatus, without_hands
from teleop.remote.asked import Asked, Refusal
from teleop.remote.desk import Desk
from teleop.remote.gateway_child import Gateway
from teleop.remote.live_shown import battery
from teleop.remote.move_state import move_state
from teleop.remote.open_door import OpenDoor
from teleop.remote.pass_errors import ShownPasses
from teleop.remote.shoot_state import shoot_state
from teleop.remote.state import Parts
from teleop.remote.stick import RemoteStick

POLL = 0.02  # s: a STOP is in the loop within 50 ms
PRESSES: Mapping[str, Command] = {
    "pause": Command.PAUSE,
    "resume": Command.GO,
    "next_key": Command.NEXT,
    "previous_key": Command.PREVIOUS,
    "abort": Command.QUIT,
}


class RunHands:
    """`gateway` is what the gateway is told, beside where the door is; None for no gateway."""

    poll = POLL

    def __init__(self, gateway: Gateway | None) -> None:
        self._gateway = gateway
        self._log, self._now = MessageLog(), 0.0
        self._motion: Motion = {}
        self._recording = False
        self._running: Running | None = None
        self._passes = ShownPasses()

    @property
    def invitation(self) -> Invitation | None:
        return None if self._gateway is None else self._gateway.invitation

    def open(self, stack: ExitStack, profile: Profile, limits: Mapping[Axis, Limits], clock: Clock) -> None:
        """Open the door, until the stack is left."""
        self._profile, self._limits, self._clock = profile, limits, clock
        self.door = OpenDoor(stack)
        self.desk = Desk(self.door.socket, RemoteStick((), float), self.line, self)

    @property
    def inputs(self) -> Sequence[Input]:
        return [self.desk]

    def attach(self, stack: ExitStack, running: Running) -> Observer:
        """To a run that is about to begin; from now on the gateway runs. What sees each tick."""
        self._running = running
        camera = any(sink.type == "camera" for sink in self._profile.sinks)
        parts = Parts(self._profile.name, self._limits, self, {}, self.desk, camera)
        publisher = self._publisher = self.door.publisher(parts, self._clock)
        stack.callback(lambda: publisher.publish("over", self._clock.now()))
        if running.source is not None:
            self._passes.watch(running.title, running.source, list(self._limits), lambda: self._halted(running))
        if self._gateway is not None:
            self.door.start(stack, self._gateway, self.desk, self._clock, self.line)
            for line in self._gateway.greetings:
                running.show(line)
        return self

    def line(self, text: str) -> None:
        self._log.notify(self._now, text)

    def observe(self, tick: Tick) -> None:
        self._now, self._motion = tick.time, tick.motion
        for action in tick.actions:
            if action in (Action.RECORD, Action.STOP):
                self._recording = action is Action.RECORD
        self._passes.observe(tick)
        self.door.look(self.desk, tick.time)
        self._publisher.publish("running", tick.time, tick)
        self.desk.flush()

    # --- what is seen

    keys: Sequence[Mapping[str, float]] = ()
    changes = 0

    focus_marks: Mapping[str, float] = MappingProxyType({})

    @property
    def presets(self) -> Mapping[str, Mapping[str, Any]]:
        return {}

    @property
    def errors(self) -> Mapping[str, Any] | None:
        return self._passes.shown

    @property
    def battery(self) -> float | None:
        return battery(self._running.drone()) if self._running else None

    @property
    def stopped_by(self) -> str:
        guard = self._running.guard() if self._running else None
        return guard.stopped_by if guard is not None and guard.stop else ""

    @property
    def status(self) -> OperatorStatus:
        inputs = [InputStatus(self.desk.name, (), "", "")]
        return without_hands(inputs, bool(self.stopped_by), self._recording, self._log.messages)

    def drivers(self) -> Mapping[Axis, str]:
        title = self._running.title if self._running else ""
        return dict.fromkeys(self._limits, title)

    def move(self, now: float) -> Mapping[str, Any] | None:
        running = self._running
        if running is None or running.source is None:
            return None
        return move_state(running.title, running.source, now, self._halted(running), attended=False)

    def shoot(self, now: float) -> Mapping[str, Any] | None:
        running = self._running
        if running is None or running.progress is None:
            return None
        return shoot_state(running.title, running.progress, now, self._halted(running))

    def _halted(self, running: Running) -> str:
        guard = running.guard()
        return "" if guard is None or not guard.halted else guard.note

    # --- what is done

    @property
    def rests(self) -> bool:
        return not any(state.velocity or state.acceleration for state in self._motion.values())

    def busy(self, session: str) -> bool:  # noqa: ARG002 - what goes on is nobody's who has come by the door
        return False

    def passing(self, now: float) -> None: ...

    def gone(self, sessions: Callable[[str], bool], now: float) -> None: ...

    def do(self, asked: Asked, now: float) -> None:
        do, running = asked.command.do, self._running
        if do == "speed" and running is not None and running.source is not None:
            running.source.playback.speed(asked["share"], now)
            if running.source.playback.refusal:
                raise Refusal(running.source.playback.refusal)
        elif do in PRESSES:
            guard = running.guard() if running else None
            if do == "pause" and guard is not None and guard.paused:
                raise Refusal("it is paused already")
            self.desk.press(asked.command.name, self._press(do))
        else:
            raise Refusal(f"{do}: not in a run that moves by itself: use teleop console")
        asked.end()

    def _press(self, do: str) -> Command:
        """The same key pauses a move and goes on with it."""
        running = self._running
        paused = running is not None and running.source is not None and running.source.playback.paused
        return Command.PAUSE if do == "resume" and paused else PRESSES[do]
