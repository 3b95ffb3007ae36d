"""The words of what an operator can send: every command with its fields, and plain words for the common ones.

`teleop send`, its help and its completion are made of the rows of a Vocabulary. A message is a value, so a plain word
stands for one whole message, and words with a choice are one row for each choice. Names are typed with spaces, `_` or
`-`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import MISSING
from difflib import get_close_matches
from enum import IntEnum
from itertools import chain
from typing import NamedTuple

from teleop.dji.message import FieldError, Message


def spoken(name: str) -> str:
    """A message's name, or what was typed, as a vocabulary has it."""
    return " ".join(name.lower().replace(".", " ").replace("_", " ").replace("-", " ").split())


def fields_of(words: Sequence[str]) -> dict[str, str]:
    """What was typed as field=value."""
    given = [word.partition("=") for word in words if "=" in word]
    return {name: value for name, _, value in given}


def rows(words: Iterable[IntEnum], prefix: str, make: type[Message], field: str) -> dict[str, Message]:
    """A plain word for each choice of a field."""
    return {
        spoken(f"{prefix} {word.name}"): make.from_fields({field: word}) for word in words if word.name != "UNCHANGED"
    }


def commands(messages: Iterable[type[Message]]) -> dict[str, type[Message]]:
    """Every message that can be sent, by its words."""
    return {spoken(cls.name): cls for cls in messages if cls.reply is False}


class Vocabulary(NamedTuple):
    """What can be sent to `devices`, whose names begin all words.

    `refused` are commands that are understood so that they can be refused with a reason; help has none of them.
    """

    devices: Sequence[str]
    commands: Mapping[str, type[Message]]
    plain: Mapping[str, Message]
    refused: Collection[type[Message]] = ()

    def find(self, words: Sequence[str]) -> Message:
        """The message that `words` ask for: `recenter`, `gimbal follow lock`, `gimbal position yaw=10 roll=0 pitch=-5`.

        The device may be left out of plain words. Ranges are not checked here. Raises FieldError.
        """
        fields = fields_of(words)
        if len(fields) < sum("=" in word for word in words):
            raise FieldError("duplicate field")
        name = self.full_name(words)
        if name in self.plain and not fields:
            return self.plain[name]
        if name in self.commands:
            command = self.commands[name]
            return command.from_fields(command.completed(fields))
        raise FieldError(f"{name} takes no fields")

    def full_name(self, words: Sequence[str]) -> str:
        """The command's name with its device: `gimbal follow lock` for `follow lock`. Raises FieldError."""
        name = spoken(" ".join(word for word in words if "=" not in word))
        for full in (name, *(f"{device} {name}" for device in self.devices)):
            if full in self.plain or full in self.commands:
                return full
        raise self._unknown(name)

    def _unknown(self, name: str) -> FieldError:
        all_words = [*self.commands, *self.plain]
        near = get_close_matches(name, list(chain(all_words, (full.split(" ", 1)[1] for full in all_words))), 1)
        return FieldError(f"unknown command {name}" + (f"; did you mean {near[0]}?" if near else ""))


class FieldHelp(NamedTuple):
    """One field of a command: what it must be, with its unit, and its default, None where it must be given."""

    name: str
    requirement: str
    default: str | None


def help_of(command: type[Message]) -> list[FieldHelp]:
    """The fields of `command` that an operator gives."""
    return [
        FieldHelp(name, wire.requirement(), None if default is MISSING else str(wire.to_json(default)).lower())
        for name, wire, default in command.layout.fields
        if name != "reserved"
    ]
