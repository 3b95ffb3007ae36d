"""A Matrice 100 that obeys nothing but Onboard SDK frames: no I/O, no clock, no other way in.

Like the simulated gimbal it is the far end of the program's own kind of Session, and exact in time. What a command
does is a row in a table; what it does to the flight is the cockpit's affair. It refuses what the real one would: all
but version and activation before it is activated, movement without control, commands of a wrong length, and numbers
that the documents do not list. A request that comes again because its acknowledgement was lost is acknowledged again
and not obeyed again.

What goes wrong with real ones can be asked for: parts of the broadcast that never come, acknowledgements that get lost,
an RC whose pilot takes over, control that is taken away, a battery that runs low, a reboot.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from typing import Any

from teleop.dji import drone
from teleop.dji.drone_words import (
    ActivationCode,
    ArmCode,
    ArmOrder,
    Code,
    ControlCode,
    ControlOrder,
    CurrentMode,
    TaskCode,
    TaskKind,
)
from teleop.dji.encryption import Cipher
from teleop.dji.frame import Frame
from teleop.dji.message import FieldError, Message
from teleop.dji.movement import COMBINATIONS, Move
from teleop.dji.onboard import SESSION
from teleop.dji.onboard_session import OnboardSession
from teleop.dji.virtual_rc import Sticks, VirtualRc
from teleop.sim.beacon import Beacon
from teleop.sim.cockpit import Cockpit
from teleop.sim.controls import Switch
from teleop.sim.drone_settings import M100, DroneSettings
from teleop.sim.orders import controls, move

VERSION = "M100 SIMULATED 03.01.10.00"
Handler = Callable[[Any], Message | None]


class SimulatedDrone:
    """A drone on the ground with its RC in F mode. `yaw` is in deg, `battery` in %, `health` the GPS's, 0..5.

    `mirrors`: see Beacon. With `cipher` all that follows its activation is encrypted. While `acknowledges` is False,
    requests are obeyed and their acknowledgements get lost.
    """

    def __init__(
        self,
        *,
        now: float = 0.0,
        yaw: float = 0.0,
        battery: float = 100.0,
        health: int = 5,
        mirrors: bool = False,
        cipher: Cipher | None = None,
        settings: DroneSettings = M100,
    ) -> None:
        self.counts: Counter[str] = Counter()  # messages by name as they were understood; "refused" those not obeyed
        self.settings = settings
        self.cockpit = Cockpit(now, math.radians(yaw), battery, settings)
        self.acknowledges = True
        self.activated = False
        self._beacon = Beacon(mirrors, health)
        self._session = OnboardSession()
        self._cipher = cipher
        self._outgoing = bytearray()
        self._acknowledged: dict[int, tuple[int, bytes]] = {}  # by session: the last sequence, and what was said to it
        self._booted = -math.inf
        self._asked: ControlOrder | None = None  # what has to be sent again to be confirmed
        self._lost_control = 0  # how often the onboard computer was told
        self._handlers: dict[type[Message], Handler] = {
            drone.Version: self._version,
            drone.Activate: self._activate,
            drone.Frequency: self._set_frequency,
            drone.Control: self._control,
            drone.Task: self._task,
            drone.Arm: self._arm,
            Move: self._move,
            VirtualRc: self._virtual_rc,
            Sticks: self._sticks,
        }

    def receive(self, data: bytes, now: float) -> None:
        """Obeys the frames that `data`, arriving at `now` (s, never going back), completes."""
        self._pass(now)
        if now < self._booted:
            return
        for received in self._session.receive(data, now):
            if received.frame.is_reply:
                continue
            self.counts[received.message.name] += 1
            self._obey(received.frame, received.message)

    def advance(self, now: float) -> bytes:
        """What it has sent up to `now`: acknowledgements, and its broadcast at its own times."""
        self._pass(now)
        sent = bytes(self._outgoing)
        self._outgoing.clear()
        return sent

    def hide(self, *parts: str) -> None:
        """These parts of the broadcast no longer come, the others do."""
        self._beacon.hidden = parts

    def turn_switch(self, now: float, switch: Switch) -> None:
        """The pilot turns the mode switch of the real RC."""
        self._pass(now)
        self.cockpit.turn_switch(switch)

    def lose_control(self, now: float) -> None:
        """Control is taken from the onboard computer, by whatever has the right to."""
        self._pass(now)
        self.cockpit.lose_control()
        self.cockpit.control_lost = max(self.cockpit.control_lost, self._lost_control + 1)

    def set_battery(self, now: float, percent: float) -> None:
        self._pass(now)
        self.cockpit.set_battery(percent)

    def reboot(self, now: float, seconds: float) -> None:
        """On the ground it goes out, hears and says nothing for so long, and is then as at first."""
        self._pass(now)
        self._booted = now + seconds
        self.activated = False
        self._session.cipher = None
        self._beacon.end()
        self._outgoing.clear()
        self._asked = None
        self.cockpit = Cockpit(now, self.cockpit.pose.yaw, self.cockpit.battery, self.settings)

    def _pass(self, now: float) -> None:
        for time, parts in self._beacon.due(now):
            self._pass_cockpit(time)
            self._outgoing += self._session.command(self._beacon.say(self.cockpit, parts))
        self._pass_cockpit(now)

    def _pass_cockpit(self, now: float) -> None:
        self.cockpit.pass_to(now)
        while self._lost_control < self.cockpit.control_lost:
            self._lost_control += 1
            self._outgoing += self._session.request(drone.Pushed(), now)[0]
        for again in self._session.due(now):
            self._outgoing += again
        self._session.overdue(now)

    def _obey(self, frame: Frame, message: Message) -> None:
        session = frame.cmd_type & SESSION
        again = self._acknowledged.get(session)
        if session >= drone.ACKNOWLEDGED and again and again[0] == frame.sequence:
            self._say(again[1])
            return
        answer = self._answer(message)
        if answer is None or session == 0:
            return
        acknowledgement = self._session.reply(frame, answer)
        self._acknowledged[session] = frame.sequence, acknowledgement
        self._say(acknowledgement)

    def _say(self, acknowledgement: bytes) -> None:
        if self.acknowledges:
            self._outgoing += acknowledgement

    def _answer(self, message: Message) -> Message | None:
        handler = self._handlers.get(type(message))
        if handler is None:
            self.counts["refused"] += 1
            return None
        if not self.activated and not isinstance(message, drone.Version | drone.Activate):
            self.counts["refused"] += 1
            return NOT_ACTIVATED.get(type(message))
        try:
            message.check()
        except FieldError:
            self.counts["refused"] += 1
            return None
        return handler(message)

    def _version(self, _query: drone.Version) -> Message:
        code = Code.OK if self.activated else Code.NOT_ACTIVATED
        return drone.VersionAck(code, 0, "SIMULATED", VERSION)

    def _activate(self, _message: drone.Activate) -> Message:
        self.activated = True
        self._session.cipher = self._cipher
        self._beacon.begin(self.cockpit.time)
        return drone.ActivateAck(ActivationCode.OK)

    def _set_frequency(self, message: drone.Frequency) -> Message:
        self._beacon.set(message)
        return drone.FrequencyAck(Code.OK)

    def _control(self, message: drone.Control) -> Message:
        """Each order is confirmed when it comes for the second time (OPENProtocol.md 3.1.9, 01 00)."""
        obtains = message.order == ControlOrder.OBTAIN
        if obtains and not self.cockpit.may_obtain:
            self._asked = None
            return drone.ControlAck(ControlCode.NOT_IN_F_MODE)
        if self.settings.asks_twice and self.cockpit.obtained != obtains and self._asked != message.order:
            self._asked = ControlOrder(message.order)
            return drone.ControlAck(ControlCode.OBTAINING if obtains else ControlCode.RELEASING)
        self._asked = None
        if obtains:
            self.cockpit.obtain()
            return drone.ControlAck(ControlCode.OBTAINED)
        self.cockpit.release()
        return drone.ControlAck(ControlCode.RELEASED)

    def _task(self, message: drone.Task) -> Message:
        """Without control it fails as any other (the maker's sample LinuxFlight.cpp, takeoff and landing)."""
        cockpit = self.cockpit
        tasks = {
            TaskKind.RETURN_HOME: cockpit.go_home,
            TaskKind.TAKE_OFF: cockpit.take_off,
            TaskKind.LAND: cockpit.land,
        }
        starts = cockpit.obtained and tasks[TaskKind(message.task)]()
        return drone.TaskAck(TaskCode.STARTED if starts else TaskCode.FAILED)

    def _arm(self, message: drone.Arm) -> Message:
        flight = self.cockpit.flight
        if not self.cockpit.obtained:
            return drone.ArmAck(ArmCode.NEED_CONTROL)
        if flight.motors == (message.order == ArmOrder.ARM):
            return drone.ArmAck(ArmCode.ALREADY)
        if flight.airborne:
            return drone.ArmAck(ArmCode.IN_THE_AIR)
        if message.order == ArmOrder.ARM:
            flight.start_motors()
        else:
            flight.stop_motors()
        return drone.ArmAck(ArmCode.OK)

    def _move(self, message: Move) -> None:
        if not self.cockpit.obtained:
            self.counts["refused"] += 1
            return
        assert message.combination is not None
        self._beacon.mode = CurrentMode(COMBINATIONS.index(message.combination) + 1)
        self.cockpit.moves(lambda flight: move(flight, message))

    def _virtual_rc(self, message: VirtualRc) -> None:
        if message.on:
            self.cockpit.enable_virtual(message.back_to_rc)
        else:
            self.cockpit.disable_virtual(message.back_to_rc)

    def _sticks(self, message: Sticks) -> None:
        self.cockpit.virtual_sticks(controls(message))


NOT_ACTIVATED: dict[type[Message], Message] = {
    drone.Frequency: drone.FrequencyAck(Code.NOT_ACTIVATED),
    drone.Control: drone.ControlAck(ControlCode.NOT_ACTIVATED),
    drone.Task: drone.TaskAck(Code.NOT_ACTIVATED),
    drone.Arm: drone.ArmAck(ArmCode.NOT_ACTIVATED),
}
