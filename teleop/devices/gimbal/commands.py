"""A gimbal's own commands and its dial, as an operator gives them by hand.

A command that cannot be sent is a message to the operator and ends nothing: a wrong button is no fault of the run. What
would move the gimbal by itself is not passed on, because the next command of the stream would take it back. The dial
is a stream without answers, so its last word is always a zero, and giving the gimbal back says it too.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from teleop.config.device_commands import DRONE
from teleop.core.events import DeviceCommand, DialInput, Tick
from teleop.devices.connection import Answer, Connection
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.command_table import find, is_taken_back
from teleop.dji.message import FieldError, Message

FULL_DIAL = 2048  # R SDK V2.5, section 2.3.4.11
DIAL_PERIOD = 0.02  # s between two words of the dial, at least


class Unheard:
    """Reports each command for a device that this rig does not have."""

    def __init__(self, gimbal: bool, drone: bool, notify: Callable[[str], object]) -> None:
        self._gimbal, self._drone, self._notify = gimbal, drone, notify

    def observe(self, tick: Tick) -> None:
        for act in tick.actions:
            if isinstance(act, DeviceCommand):
                addressee, is_there = ("drone", self._drone) if act.device == DRONE else ("gimbal", self._gimbal)
                if not is_there:
                    self._notify(f"{act}: this rig has no {addressee}")


class CommandSink:
    """Gives `DeviceCommand` and `DialInput` to the gimbal on a connection; `notify` is for what comes of it.

    `done` is called with each command that the gimbal has confirmed.
    """

    def __init__(
        self,
        connection: Connection,
        notify: Callable[[str], object],
        done: Callable[[DeviceCommand], object] = lambda _command: None,
    ) -> None:
        self._connection, self._notify, self._done = connection, notify, done
        self._asked: dict[int, DeviceCommand] = {}  # by sequence number
        self._kinds: set[type[Message]] = set()
        self._dial = self._sent_dial = 0
        self._sent_at = -math.inf

    def write(self, tick: Tick) -> None:
        for act in tick.actions:
            if isinstance(act, DeviceCommand) and act.device != DRONE:
                self._send(act, tick.time)
            elif isinstance(act, DialInput):
                self._dial = round(max(-1.0, min(1.0, act.speed)) * FULL_DIAL)
        if self._asked:
            self._connection.poll(tick.time)  # the gimbal may have no axis in this run, and so no other poll
        if (self._dial or self._sent_dial) and tick.time - self._sent_at > DIAL_PERIOD - 1e-6:
            self._sent_at = tick.time
            self._push_dial(self._dial)

    def release(self, now: float) -> float | None:  # noqa: ARG002 - one step, at once
        if self._sent_dial:
            self._push_dial(0)
        return None

    def _push_dial(self, speed: int) -> None:
        self._connection.stream(gimbal.Dial(speed))
        self._sent_dial = speed

    def _send(self, command: DeviceCommand, now: float) -> None:
        try:
            message = find(str(command).split())
            message.check()
        except FieldError as error:
            self._notify(f"{command}: {error}")
            return
        if is_taken_back(message):
            self._notify(f"{command} refused: it would disturb the commands of the run")
            return
        if not message.has_reply:
            self._connection.stream(message)
            self._notify(f"{command}: sent; this command has no reply")
            return
        if type(message) not in self._kinds:
            self._kinds.add(type(message))
            self._connection.on_answer(type(message), self._answered)
        self._asked[self._connection.request(message, now)] = command

    def _answered(self, answer: Answer) -> None:
        command = self._asked.pop(answer.sequence, None)
        if command is None:
            return
        code = getattr(answer.reply, "return_code", 0)
        if answer.reply is None:
            self._notify(f"{command}: no answer")
        else:
            self._notify(f"{command}: refused (return code {code:#04x})" if code else f"{command}: done")
            if not code:
                self._done(command)
