"""A Matrice 100 that obeys nothing but Onboard SDK frames: no I/O, no clock, no other way in.

Like the simulated gimbal it is the far end of the program's own kind of Session, and exact in time. What a command
does is a row in the table of DroneHandlers; what it does to the flight is the autopilot's affair. It refuses what the
real one would: nearly all before it is activated, movement without control, commands of a wrong length, and numbers
that the documents do not list; `refusals` has each with its reason.

What goes wrong with real ones can be asked for: parts of the broadcast that never come, acknowledgements that get lost
or come late, an RC whose pilot takes over, control that is taken away, a battery that runs low, a reboot.
"""

from __future__ import annotations

import math
from collections import Counter

from teleop.dji.drone import messages as drone
from teleop.dji.drone.encryption import Cipher
from teleop.dji.drone.enums import Code
from teleop.dji.drone.onboard_sdk import SESSION
from teleop.dji.drone.session import OnboardSession
from teleop.dji.frame import Frame
from teleop.dji.gimbal.session import Received
from teleop.dji.message import Message, Opaque
from teleop.sim.drone.acknowledgements import Acknowledgements
from teleop.sim.drone.autopilot import Autopilot
from teleop.sim.drone.controls import Switch
from teleop.sim.drone.handlers import DroneHandlers
from teleop.sim.drone.payload import Payload
from teleop.sim.drone.settings import M100, DroneSettings
from teleop.sim.drone.telemetry import TelemetrySender
from teleop.sim.refusals import Refusals, Why


class SimulatedDrone:
    """A drone on the ground with its RC in F mode. `yaw` is in deg, `battery` in %, `health` the GPS's, 0..5.

    `mirrors`: see Beacon. With `cipher` all that follows its activation is encrypted. While `acknowledges` is False,
    requests are obeyed and their acknowledgements get lost. `counts` has the messages by name as they were understood,
    and as "refused" those not obeyed.
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
        self.counts: Counter[str] = Counter()
        self.refusals = Refusals()
        self.settings = settings
        self.acknowledges = True
        self._telemetry = TelemetrySender(mirrors, health, settings)
        self._session = OnboardSession()
        self._cipher = cipher
        self._outgoing = bytearray()
        self._acknowledgements = Acknowledgements(settings.answer_delay)
        self._booted = -math.inf
        self._lost_control = 0  # how often the onboard computer was notified
        self._boot(now, math.radians(yaw), battery)

    def _boot(self, now: float, heading: float, battery: float) -> None:
        self.autopilot = Autopilot(now, heading, battery, self.settings)
        self._commands = DroneHandlers(self.autopilot, self._telemetry, self.settings, self._refuse)
        self._handlers = self._commands.handlers
        self._session.cipher = None
        if self.settings.broadcasts_before_activation:
            self._telemetry.begin(now)

    @property
    def activated(self) -> bool:
        return self._commands.activated

    @property
    def payload(self) -> Payload:
        """Its gimbal and its camera."""
        return self._commands.payload

    def receive(self, data: bytes, now: float) -> None:
        """Obeys the frames that `data`, arriving at `now` (s, never going back), completes."""
        self._pass(now)
        if now < self._booted:
            return
        damage = self._session.last_damage
        for received in self._session.receive(data, now):
            if not received.frame.is_reply:
                self._obey(received, now)
        if self._session.last_damage is not damage and self._session.last_damage:
            self.refusals.add_damage(now, self._session.last_damage)

    def advance(self, now: float) -> bytes:
        """What it has sent up to `now`: acknowledgements, and its broadcast at its own times."""
        self._pass(now)
        sent = bytes(self._outgoing)
        self._outgoing.clear()
        return sent

    def hide(self, *parts: str) -> None:
        """These parts of the broadcast no longer come, the others do."""
        self._telemetry.hidden = parts

    def turn_switch(self, now: float, switch: Switch) -> None:
        """The pilot turns the mode switch of the real RC."""
        self._pass(now)
        self.autopilot.turn_switch(switch)

    def carry(
        self, now: float, seconds: float, *, roll: float = 0.0, pitch: float = 0.0, yaw: float = 0.0, up: float = 0.0
    ) -> None:
        """A hand turns and lifts it, with its motors off, within so many seconds: deg and m against how it stands."""
        self._pass(now)
        self.autopilot.hand.move(now, (math.radians(roll), math.radians(pitch), math.radians(yaw), up), seconds)

    def lose_control(self, now: float) -> None:
        """Control is taken from the onboard computer, by whatever has the right to."""
        self._pass(now)
        self.autopilot.lose_control()
        self.autopilot.control_lost = max(self.autopilot.control_lost, self._lost_control + 1)

    def set_battery(self, now: float, percent: float) -> None:
        self._pass(now)
        self.autopilot.set_battery(percent)

    def reboot(self, now: float, seconds: float) -> None:
        """On the ground it goes out, hears and says nothing for so long, and is then as at first."""
        self._pass(now)
        self._booted = now + seconds
        self._lost_control = 0
        self._telemetry.end()
        self._acknowledgements.forget()
        self._outgoing.clear()
        self._boot(self._booted, self.autopilot.pose.yaw, self.autopilot.battery)

    def _pass(self, now: float) -> None:
        for time, parts in self._telemetry.due(now):
            self._advance_autopilot(time)
            self._outgoing += self._session.command(self._telemetry.notify(self.autopilot, self.payload, parts))
        self._advance_autopilot(now)

    def _advance_autopilot(self, now: float) -> None:
        self._outgoing += self._acknowledgements.due(now)
        self.autopilot.pass_to(now)
        while self._lost_control < self.autopilot.control_lost:
            self._lost_control += 1
            self._outgoing += self._session.request(drone.Pushed(), now)[0]
        for again in self._session.due(now):
            self._outgoing += again
        self._session.overdue(now)

    def _refuse(self, command: str, why: Why, detail: str) -> None:
        self.counts["refused"] += 1
        self.refusals.add(self.autopilot.time, command, why, detail)

    def _obey(self, received: Received, now: float) -> None:
        frame = received.frame
        self.counts[received.message.name] += 1
        session = frame.cmd_type & SESSION
        if session >= drone.ACKNOWLEDGED and (before := self._acknowledgements.to_repetition(frame, now)):
            self._give(before, now)
            return
        answer = self._answer(frame, received.message)
        if answer is None or session == 0:
            return
        acknowledgement = self._session.reply(frame, answer)
        self._acknowledgements.remember(frame, acknowledgement, now)
        self._give(acknowledgement, now)
        if self.activated:
            self._session.cipher = self._cipher

    def _answer(self, frame: Frame, message: Message) -> Message | None:
        if frame.is_encrypted and isinstance(message, Opaque) and not self._commands.knows(message):
            detail = "decrypted, it is no command" if self._session.cipher else "it has no key, or none yet"
            self._refuse("encrypted", Why.KEY, detail)
            return drone.FrequencyAck(Code.KEY_ERROR)  # any code of two bytes
        return self._commands.answer(message)

    def _give(self, acknowledgement: bytes, now: float) -> None:
        if self.acknowledges:
            self._acknowledgements.give(acknowledgement, now)
            self._outgoing += self._acknowledgements.due(now)
