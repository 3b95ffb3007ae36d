"""The controls that answered, in a profile's words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from teleop.app.learn.questions import Question
from teleop.config.inputs_section import DIRECTIONS, ControlSection
from teleop.core.axes import STICKS
from teleop.inputs.hid.learn import Found, Kind

ONE_WAY = (Kind.TRIGGER, Kind.BUTTON)
_KNOWN_KEYS = ("value_type", "range", "center", "coarse")  # of a shipped mapping, that stay with the control


@dataclass(frozen=True)
class Answer:
    """A control of a device that answered; `back`: in the other direction. `known` is what is known of the control."""

    question: Question
    device: int
    found: Found
    back: bool = False
    known: ControlSection | None = None

    @property
    def action(self) -> Mapping[str, Any]:
        """What the control does, as a profile has it; empty for the enable button."""
        question = self.question
        if question.moves:
            what = {"dial": True} if question.axis is None else {"axis": question.axis.value}
            return {**what, **self._described(), **_moves(self.found, self.back, question.dial)}
        if question.press is None:
            return {}
        number = {} if question.number is None else {"number": question.number}
        hold = {} if question.hold is None else {"hold": question.hold.value}
        command = {"command": question.command} if question.command else {}
        return {"press": question.press.value, **number, **hold, **command}

    def _described(self) -> Mapping[str, Any]:
        if self.known is None or self.known.value_type is None:
            return {}
        given = self.known.model_dump(include=set(_KNOWN_KEYS), exclude_none=True)
        return {key: given[key] for key in _KNOWN_KEYS if key in given}


@dataclass
class Answers:
    """All answers, in the order in which they came."""

    given: list[Answer] = field(default_factory=list)

    def user_of(self, device: int, name: str) -> Question | None:
        """The question that this control has answered already."""
        return next((each.question for each in self.given if (each.device, each.found.name) == (device, name)), None)

    def drop(self, question: Question) -> None:
        self.given = [each for each in self.given if each.question != question]

    @property
    def devices(self) -> Sequence[int]:
        """The devices that have answered, in the order of their first answers."""
        return list(dict.fromkeys(each.device for each in self.given))

    def questions(self) -> Sequence[Question]:
        return list(dict.fromkeys(each.question for each in self.given))

    def controls(self, device: int) -> Mapping[str, Mapping[str, Any]]:
        """What each control of the device does; the directions of a hat by their own names: `Hat switch up`."""
        return {each.found.name: each.action for each in self.given if each.device == device and each.action}

    def enable(self, device: int) -> str | None:
        names = [each.found.name for each in self.given if each.device == device and each.question.enable]
        return names[0] if names else None


def refusal(question: Question, found: Found, hats: Sequence[str] = ()) -> str:
    """Why this control of a device with these `hats` cannot answer, "" where it can."""
    if question.dial and hat_direction(found.name, hats)[1]:
        return f"{found.name} cannot turn the dial"
    if found.kind is Kind.LEVER and (question.dial or question.axis in STICKS):
        return f"{found.name} does not return to its center"
    if found.kind in (Kind.WHEEL, Kind.COUNTER) and question.axis in STICKS:
        return f"{found.name} is turned and cannot be held"
    if found.kind is Kind.TRIGGER and found.towards < 0 and question.axis in STICKS:
        return f"{found.name} rests at its upper end"
    presses = found.kind is Kind.BUTTON or (found.kind is Kind.TRIGGER and found.towards > 0)
    if not question.moves and not presses:
        return f"{found.name} is no button"
    return ""


def hat_direction(name: str, hats: Sequence[str]) -> tuple[str, str]:
    """`Hat switch up` as the hat and its direction, of these `hats`; of anything else no direction."""
    hat, _, last = name.rpartition(" ")
    return (hat, last) if hat in hats and last in DIRECTIONS else (name, "")


def _moves(found: Found, back: bool, dial: bool) -> Mapping[str, Any]:
    towards = -found.towards if back else found.towards
    if found.kind is Kind.TRIGGER:  # it moves away from its end, whichever that is
        rest = {"rest": "low" if found.towards > 0 else "high"}
        return {**rest, "invert": True} if back else rest
    kind = {Kind.LEVER: {"by": "position"}, Kind.COUNTER: {"value_type": "counter"}}.get(found.kind, {})
    if found.kind in (Kind.WHEEL, Kind.COUNTER) and not dial:
        kind = {**kind, "by": "position"}
    return {**kind, "invert": True} if towards < 0 else kind
