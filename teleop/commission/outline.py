"""All steps of a commissioning in a list, each with what came of it."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from typing import NamedTuple

from teleop.commission.findings import Fact, Findings, Verdict
from teleop.commission.step import Step

SKIPPED = "skipped"
"""How a fact of a step that the operator skipped was found."""


class Result(StrEnum):
    """What came of a step so far."""

    COMING = ""
    NOW = "now"
    DONE = "done"
    DIFFERENT = "different"
    NOT_SEEN = "not seen"
    SKIPPED = "skipped"


class Entry(NamedTuple):
    key: str
    title: str
    result: Result


def outline(steps: Sequence[Step], findings: Findings, index: int) -> Sequence[Entry]:
    """The steps in their order; that at `index` is under way."""
    facts: dict[str, list[Fact]] = {}
    for fact in findings.facts:
        facts.setdefault(fact.step, []).append(fact)
    return [
        Entry(step.key, step.title, Result.NOW if place == index else _result(facts.get(step.key, []), place < index))
        for place, step in enumerate(steps)
    ]


def _result(facts: Sequence[Fact], is_past: bool) -> Result:
    if not facts:
        return Result.DONE if is_past else Result.COMING
    if all(fact.verdict is Verdict.NOT_SEEN for fact in facts):
        return Result.SKIPPED if all(fact.how == SKIPPED for fact in facts) else Result.NOT_SEEN
    return Result.DIFFERENT if any(fact.verdict is Verdict.DIFFERENT for fact in facts) else Result.DONE
