"""The control process's side of the door: takes what has come, checks who may, has it done, and answers.

It is an input of the operator: a STOP or a record is a press of the person whose command it was. It takes a bounded
number of datagrams per tick and never waits. A command that comes again is answered again and not done again.
"""

from __future__ import annotations

import math
from collections import OrderedDict
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any

from teleop.core.events import DeviceCommand
from teleop.core.operator_input import Command, Held, Press
from teleop.door.messages import INTERNAL, CommandError, DoorCommand, checked, packed, unpacked
from teleop.door.sockets import CommandSocket, Datagram
from teleop.remote.aims import Aims
from teleop.remote.asked import Actions, Asked, Counts, Refusal
from teleop.remote.control import Control, Denied
from teleop.remote.stick import RemoteStick

MOST = 32  # datagrams in a tick
ANSWERS = 512  # that are kept, for commands that come again
GONE = 2.0  # s without a word of a console, or of the gateway, after which its move pauses


class Desk:
    """`actions` are what the commands do in this run; `notify` takes lines for everybody.

    A session of which nothing is heard for `gone` s counts as gone.
    """

    name = "console"

    def __init__(
        self,
        socket: CommandSocket,
        stick: RemoteStick,
        notify: Callable[[str], object],
        actions: Actions,
        gone: float = GONE,
    ) -> None:
        self._socket, self.stick, self.actions, self._gone = socket, stick, actions, gone
        self.control = Control(notify)
        self.counts = Counts()
        self.aims = Aims()
        self.tick, self.polled_at = 0, -math.inf
        self.gateway_at = -math.inf  # when the gateway was heard last
        self._answers: OrderedDict[tuple[str, int], bytes] = OrderedDict()
        self._seen: dict[str, float] = {}  # sessions whose page tells that it lives, and when it last did
        self._closed: OrderedDict[str, None] = OrderedDict()
        self._presses: list[Press] = []
        self._unsaid: list[tuple[dict[str, Any], str]] = []
        self._asker: Asked | None = None
        self._brief: dict[str, set[Asked]] = {}  # by session, what control was taken for alone
        self._changes = 0

    # --- the input

    def read(self, now: float) -> Held:
        """Take what has come; what was pressed."""
        self.poll(now)
        presses, self._presses = self._presses, []
        return Held(presses=presses)

    def press(self, name: str, command: Command, number: int = 0, device_command: DeviceCommand | None = None) -> None:
        self._presses.append(Press(command, number, device_command, name))

    def poll(self, now: float) -> None:
        self.polled_at = now
        for datagram in self._socket.receive(MOST):
            self.counts.taken += 1
            self.take(datagram, now)
        rests = self.actions.rests
        holder = self.control.holder
        busy = holder is not None and self.actions.busy(holder.session)
        if self.stick.age(now) is not None:
            self.control.use(now)
        self.control.step(now, rests, busy)
        if self.control.passing:
            self.actions.passing(now)
        self._follow_control()
        self.actions.gone(lambda session: self._is_gone(session, now), now)

    def _follow_control(self) -> None:
        """The stick is the holder's, while control does not pass to another one."""
        holder, control = self.control.holder, self.control
        session = holder.session if holder is not None and not control.leaving else ""
        if session != self.stick.session or control.changes != self._changes:
            self._changes = control.changes
            self.stick.give(session, control.name)
        if (asker := self._asker) is not None and control.asking is None and not control.passing:
            self._asker = None
            asker.end("" if control.holds(asker.command.session) else f"{control.name or 'the holder'} said no")

    def _is_gone(self, session: str, now: float) -> bool:
        """Whether nobody is behind a session any more: closed, its page silent, or the gateway silent."""
        if session in self._closed or now - self.gateway_at > self._gone:
            return True
        return session in self._seen and now - self._seen[session] > self._gone

    @property
    def seen_last(self) -> float:
        """When any page or program was there."""
        return max(self._seen.values(), default=-math.inf)

    def all_gone(self, now: float) -> None:
        """The gateway has ended, and with it every connection."""
        self.gateway_at = -math.inf
        for person in (self.control.holder, self.control.asking):
            if person is not None:
                self._close(person.session, now)

    def idle(self, now: float, why: str) -> str:
        """While no run of the rig goes on: a STOP is for the next one; why all was given up, "" as long as it was not.

        All else is refused with `why`.
        """
        given_up = ""
        for datagram in self._socket.receive(MOST):
            with suppress(CommandError):
                command = checked(unpacked(datagram.data))
                asked = Asked(command, datagram.address, self)
                if command.do in INTERNAL:
                    self._internal(command, now)
                elif command.do == "stop":
                    self._do(asked, now)
                elif command.do == "abort" and (self.control.holder is None or self.control.holds(command.session)):
                    given_up = f"aborted by {command.name}"
                    asked.end()
                elif command.do != "stick":
                    asked.refuse(Refusal(why))
        self.flush()
        return given_up

    # --- one datagram

    def take(self, datagram: Datagram, now: float) -> None:
        try:
            command = checked(unpacked(datagram.data))
        except CommandError as error:
            self.counts.malformed += 1
            self._send({"id": error.id, "error": str(error)[:200], "kind": "invalid"}, datagram.address)
            return
        self.counts.kinds[command.do] += 1
        if command.do == "stick":
            self.stick.take(command.session, command.fields, command.time / 1000, now)
        elif command.do in INTERNAL:
            self._internal(command, now)
        elif (before := self._answers.get((datagram.address, command.id))) is not None:
            self._socket.answer(before, datagram.address)
        elif not any(to == datagram.address and each["id"] == command.id for each, to in self._unsaid):
            self._do(Asked(command, datagram.address, self), now)

    def _internal(self, command: DoorCommand, now: float) -> None:
        if command.do == "closed":
            self._close(command.session, now)
            return
        if command.do == "aim":
            self.aims.take(command.fields["source"], command.time / 1000, command.fields["axes"], now)
            return
        self.gateway_at = now
        for session, age in command.fields.get("seen", {}).items():
            self._seen[session] = max(self._seen.get(session, -math.inf), now - age / 1000)
        if len(self._seen) > ANSWERS:
            self._seen = {session: at for session, at in self._seen.items() if now - at < 60.0}

    def _close(self, session: str, now: float) -> None:
        self._closed[session] = None
        while len(self._closed) > ANSWERS:
            self._closed.popitem(last=False)
        self.control.closed(session, now)
        self.stick.forget(session)

    def _do(self, asked: Asked, now: float) -> None:
        self._closed.pop(asked.command.session, None)
        try:
            match asked.command.do:
                case "stop":
                    self.press(asked.command.name, Command.STOP)
                    asked.end()
                case "take_control":
                    self._take_control(asked, now)
                case "release_control":
                    self.authorize(asked, now)
                    self.control.release(asked.command.session, now)
                    asked.end()
                case "deny_control":
                    self.authorize(asked, now)
                    self.control.deny()
                    asked.end()
                case "clear":
                    if self.control.holder is not None:
                        self.authorize(asked, now)
                    self.press(asked.command.name, Command.CLEAR)
                    asked.end()
                case _:
                    self.authorize(asked, now)
                    self.actions.do(asked, now)
        except Refusal as refusal:
            self.counts.refused += 1
            asked.refuse(refusal)
        except Exception as fault:  # noqa: BLE001 - a command from outside never ends the run
            self.counts.faults += 1
            asked.refuse(Refusal(f"{asked.command.do}: {type(fault).__name__}: {fault}"[:200]))

    def authorize(self, asked: Asked, now: float) -> None:
        """Raises Refusal for one who has no control, unless it is free and is taken for this alone."""
        control, command = self.control, asked.command
        if command.brief and (control.holder is None or control.holds(command.session)):
            control.take(asked.person, now, brief=True)
            self._brief.setdefault(command.session, set()).add(asked)
        if not control.holds(command.session):
            if control.holder is None:
                raise Refusal("take control first")
            raise Refusal(f"{control.name} has control", "busy", control.name)
        control.use(now)

    def _take_control(self, asked: Asked, now: float) -> None:
        try:
            has = self.control.take(asked.person, now, asked.get("ask", False))
        except Denied as denied:
            raise Refusal(str(denied), "busy", denied.holder) from None
        if has:
            asked.end()
        else:
            asked.accept()
            self._asker = asked

    def action_over(self, asked: Asked) -> None:
        """A control that was taken for single actions alone ends with the last of them."""
        session = asked.command.session
        under_way = self._brief.get(session, set())
        under_way.discard(asked)
        if under_way:
            return
        self._brief.pop(session, None)
        if asked.command.brief and self.control.brief and self.control.holds(session):
            self.control.release(session, self.polled_at)
            self.control.step(self.polled_at, self.actions.rests, False)

    # --- answers

    def answer(self, asked: Asked, message: Mapping[str, Any]) -> None:
        """Once the state of this tick is written (`flush`): who is answered finds it there."""
        self._unsaid.append(({"id": asked.command.id, **message}, asked.address))

    def flush(self) -> None:
        """Send what there is to answer, after the state of the tick."""
        unsaid, self._unsaid = self._unsaid, []
        for message, address in unsaid:
            data = self._send({**message, "tick": self.tick}, address)
            if data and not message.get("done"):
                self._answers[address, message["id"]] = data
                while len(self._answers) > ANSWERS:
                    self._answers.popitem(last=False)

    def _send(self, message: Mapping[str, Any], address: str) -> bytes:
        data = b""
        with suppress(CommandError):  # a reason that is too long: there is no answer then
            data = packed(message)
            self._socket.answer(data, address)
        return data
