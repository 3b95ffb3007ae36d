"""Which class a frame's data is, and which data a name means: rows of classes, looked up by set, id, direction, fit.

Replies of old firmware carry neither set nor id (V2.5 release note 2.2.0.5). Their first byte distinguishes them:
a return code, which is never the number of a command set. What they answer only the request can say, so whoever
knows the request passes its set and id.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping
from types import ModuleType
from typing import Any, NamedTuple

from teleop.dji.frame import Frame
from teleop.dji.message import FieldError, Message, Opaque, Result, bytes_from_json, suggestion


def messages_of(module: ModuleType) -> list[type[Message]]:
    """The message classes that `module` defines, in the order in which they stand there."""
    return [
        value
        for value in vars(module).values()
        if isinstance(value, type) and issubclass(value, Message) and value.__module__ == module.__name__
    ]


class Decoded(NamedTuple):
    """A message, the set and id it was decoded under, and whether the frame left those out (`bare`)."""

    message: Message
    set_and_id: bytes
    bare: bool = False


class Registry:
    """The messages of one protocol. `sets` names its command sets, `names` commands that have several messages."""

    replies_have_command = True  # as a rule: old firmware's do not

    def __init__(
        self, sets: Mapping[int, str], messages: Iterable[type[Message]], names: Mapping[bytes, str] | None = None
    ) -> None:
        self.messages = tuple(messages)
        self._sets = dict(sets)
        self._classes: dict[bool, dict[bytes, list[type[Message]]]] = {False: {}, True: {}}
        self._commands: dict[str, bytes] = {}
        for cls in self.messages:
            for reply in (False, True) if cls.reply is None else (cls.reply,):
                self._classes[reply].setdefault(cls.set_and_id, []).append(cls)
            self._commands[cls.name] = cls.set_and_id
        unique = {command: name for name, command in self._commands.items() if self._names_of(command) == {name}}
        self._names = unique | dict(names or {})
        self._pushes = {cls.set_and_id for cls in self.messages if cls.reply is None}

    def _names_of(self, command: bytes) -> set[str]:
        return {cls.name for cls in self.messages if cls.set_and_id == command}

    def is_push(self, command: bytes) -> bool:
        """Whether a device sends the command with this set and id unasked, be it with the reply bit."""
        return command in self._pushes

    def exchange(self, frame: Frame) -> Hashable:
        """What a reply shares with its request and, as far as that goes, with no other frame."""
        return frame.sequence

    def decode(self, frame: Frame, request: bytes = b"") -> Decoded:
        """What `frame` says; `request` is the set and id that it answers, b"" if unknown. Never raises.

        What no class describes is Opaque, a reply of nothing but a return code is Result.
        """
        data, reply, command = frame.data, frame.is_reply, frame.data[:2]
        if not data or frame.is_encrypted:
            return Decoded(Opaque(b"", data), b"")
        if len(data) >= 2 and (not reply or command == request or data[0] in self._sets):
            return Decoded(self._decode(command, data[2:], reply), command)
        if reply and len(request) == 2:
            return Decoded(self._decode(request, data, reply), request, bare=True)
        return Decoded(Opaque(b"", data), b"")

    def _decode(self, command: bytes, value: bytes, reply: bool) -> Message:
        for cls in self._classes[reply].get(command, ()):
            message = cls.decode(value)
            if not isinstance(message, Opaque):
                return message
        is_result = reply and value and command[0] in self._sets and command not in self._pushes
        return Result.decode(value) if is_result else Opaque(command, value)

    def name(self, decoded: Decoded) -> str:
        """The name that JSON has: the message's own, or its command's where the message is of no particular one."""
        if not isinstance(decoded.message, Opaque | Result):
            return decoded.message.name
        command = decoded.set_and_id
        if not command:
            return Opaque.name
        return self._names.get(command) or f"{self._sets.get(command[0], f'{command[0]:#04x}')}.{command[1]:#04x}"

    def command(self, name: str) -> bytes:
        """Set and id that `name` stands for, nothing for `raw`. Raises FieldError."""
        if name == Opaque.name:
            return b""
        if name in self._commands:
            return self._commands[name]
        numbers = {named: number for number, named in self._sets.items()}
        group, _, command_id = name.rpartition(".")
        try:
            return bytes((numbers[group] if group in numbers else int(group, 16), int(command_id, 16)))
        except ValueError:
            raise FieldError(f"no message is called {name!r}{suggestion(name, self._commands)}") from None

    def message(self, name: str, reply: bool, fields: Mapping[str, Any]) -> Message:
        """The message that `name` and `Message.fields()` came from. Raises FieldError."""
        command = self.command(name)
        if fields.keys() == {"value"}:
            return Opaque(command, bytes_from_json(name, "value", fields["value"]))
        if reply and fields.keys() <= {"return_code", "extra"}:
            return Result.from_fields(fields)
        for cls in self._classes[reply].get(command, ()):
            if cls.name == name:
                return cls.from_fields(fields)
        raise FieldError(f"{name}: no such {'reply' if reply else 'command'}; bytes can be given as value")
