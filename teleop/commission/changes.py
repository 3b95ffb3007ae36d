"""What is different between two commissionings of the same device, as after an update of its firmware."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from teleop.commission.findings import Fact, Findings, Value, Verdict

SAME = 0.1  # of the larger of two measured numbers: closer than that, they are the same
SAME_AT_LEAST = {"deg": 0.15, "s": 0.01, "deg/s": 0.2, "Hz": 0.2}
"""By unit: measured numbers that are nearer than that are the same, however small they are."""


class Kind(StrEnum):
    """How a fact has changed."""

    VALUE = "changed"
    NEW = "seen only now"
    GONE = "seen only before"


@dataclass(frozen=True)
class Change:
    """`before` and `now` are the facts, None where there is none."""

    kind: Kind
    before: Fact | None
    now: Fact | None

    @property
    def title(self) -> str:
        fact = self.now or self.before
        return fact.title if fact else ""


def changes(before: Findings, now: Findings) -> Sequence[Change]:
    """Those facts that changed, in the order of `now`; what neither has seen is no change."""
    earlier = {fact.key: fact for fact in before.facts}
    found = [_change(earlier.pop(fact.key, None), fact) for fact in now.facts]
    found += [_change(fact, None) for fact in earlier.values()]
    return [change for change in found if change is not None]


def heading(before: Findings, now: Findings) -> Sequence[tuple[str, str, str]]:
    """What the two are about, where it differs: a name, what it was and what it is."""
    names = ("rig", "device", "model", "firmware", "adapter", "program")
    pairs = [(name, getattr(before, name), getattr(now, name)) for name in names]
    return [pair for pair in pairs if pair[1] != pair[2]]


def shown(fact: Fact | None) -> str:
    """The value that was found, as people read it."""
    return "not seen" if fact is None or fact.verdict is Verdict.NOT_SEEN else written(fact.found, fact.unit)


def written(value: Value, unit: str) -> str:
    """A value of a fact with its unit; "-" for none."""
    if value is None:
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        value = int(value) if value.is_integer() else f"{value:.4g}"
    return f"{value} {unit}".rstrip()


def _change(before: Fact | None, now: Fact | None) -> Change | None:
    was, is_now = _seen(before), _seen(now)
    if was and is_now and before and now:
        return None if _same(before, now) else Change(Kind.VALUE, before, now)
    if was or is_now:
        return Change(Kind.GONE if was else Kind.NEW, before, now)
    return None


def _seen(fact: Fact | None) -> bool:
    return fact is not None and fact.verdict is not Verdict.NOT_SEEN


def _same(before: Fact, now: Fact) -> bool:
    was, value = before.found, now.found
    if before.verdict is not now.verdict:
        return False
    if was == value or not (_is_number(was) and _is_number(value)):
        return was == value
    assert isinstance(was, int | float)
    assert isinstance(value, int | float)
    if was * value < 0 and now.unit == "":  # a sign
        return False
    return abs(was - value) <= max(SAME * max(abs(was), abs(value)), SAME_AT_LEAST.get(now.unit, 0.0))


def _is_number(value: Value) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
