"""What a commissioning has found: facts, each with its verdict, as a value that goes into a file and comes back."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from enum import StrEnum
from typing import Any

from teleop.core.errors import UsageError

Value = str | float | bool | None
FORMAT = "teleop findings 1"


class Verdict(StrEnum):
    """What a fact says about DJI's document."""

    DOCUMENTED = "as documented"
    DIFFERENT = "different"
    NOT_SEEN = "not seen"


@dataclass(frozen=True)
class Fact:
    """One fact. `documented` and `found` are in `unit`, None where there is nothing; `how` is how it was found.

    `key` is stable between versions of this program, with dots: `speed.sign.pan`. `step` is the step that found it.
    """

    key: str
    title: str
    documented: Value
    found: Value
    unit: str
    verdict: Verdict
    how: str
    step: str = ""


@dataclass(frozen=True)
class Subject:
    """What a fact is about, before it is known. Without a `documented` value anything found is as documented."""

    key: str
    title: str
    documented: Value = None
    unit: str = ""

    def found(self, value: Value, how: str, *, within: float = 0.0, different: bool | None = None) -> Fact:
        """The fact. `within` is how far a number may be from the documented one; `different` overrules that."""
        if different is None:
            different = self.documented is not None and not self._agrees(value, within)
        return self._fact(value, Verdict.DIFFERENT if different else Verdict.DOCUMENTED, how)

    def not_seen(self, how: str) -> Fact:
        return self._fact(None, Verdict.NOT_SEEN, how)

    def _agrees(self, value: Value, within: float) -> bool:
        documented = self.documented
        if isinstance(value, int | float) and isinstance(documented, int | float):
            return abs(value - documented) <= within + 1e-9
        return value == documented

    def _fact(self, value: Value, verdict: Verdict, how: str) -> Fact:
        return Fact(self.key, self.title, self.documented, value, self.unit, verdict, how)


@dataclass(frozen=True)
class Findings:
    """The facts of one commissioning, in the order in which they were found; a key has one fact.

    `device` is `gimbal` or `drone`. `serials` are serial numbers by what has them; they leave only when asked for.
    """

    rig: str
    device: str = "gimbal"
    model: str = ""
    firmware: str = ""
    adapter: str = ""
    program: str = ""
    date: str = ""
    facts: Sequence[Fact] = ()
    serials: Mapping[str, str] = field(default_factory=dict)

    def __getitem__(self, key: str) -> Fact:
        """Raises KeyError for a fact that there is not."""
        for fact in self.facts:
            if fact.key == key:
                return fact
        raise KeyError(key)

    def value(self, key: str) -> Value:
        """What was found, None where nothing was."""
        return next((fact.found for fact in self.facts if fact.key == key), None)

    def with_facts(self, facts: Iterable[Fact]) -> Findings:
        """These facts in the place of those with their keys; new ones at the end."""
        merged = {fact.key: fact for fact in self.facts} | {fact.key: fact for fact in facts}
        return replace(self, facts=tuple(merged.values()))

    def to_json(self, serials: bool = False) -> str:
        """For a file. Serial numbers are left out unless they are asked for."""
        data: dict[str, Any] = {"format": FORMAT, **asdict(self)}
        if not serials:
            del data["serials"]
        return json.dumps(data, indent=2, ensure_ascii=False) + "\n"

    @classmethod
    def from_json(cls, text: str) -> Findings:
        """Raises UsageError for a text that is none."""
        try:
            data = json.loads(text)
            if data.pop("format") != FORMAT:
                raise ValueError("another format")
            facts = tuple(Fact(**{**each, "verdict": Verdict(each["verdict"])}) for each in data.pop("facts"))
            return cls(**data, facts=facts)
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise UsageError(f"not a report of teleop commission: {error}") from None
