"""Each known unknown of the docs names a step of `teleop commission` that settles it, or says why none can."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from commission_bench import CommissionBench

from teleop.commission.drone.steps import drone_steps

DOCS = Path(__file__).parents[2] / "docs"
AXES = "pan", "tilt", "roll"


def section(page: str, begin: str, end: str) -> str:
    text = (DOCS / page).read_text(encoding="utf-8")
    return text[text.index(begin) : text.index(end, text.index(begin) + 1)]


FACTS = section("protocol-facts.md", "## Known unknowns", "The sim")
ROWS = re.findall(r"^\| ([^|]+?) \| ([^|]+?) \|$", FACTS, re.MULTILINE)
UNKNOWNS = {unknown: step for unknown, step in ROWS if unknown not in ("unknown", "---")}
UNTRIED = section("explanation/untested.md", "- whether a real", "## Each unknown")
OPEN = [" ".join(entry.split()) for entry in re.split(r"^- ", UNTRIED, flags=re.MULTILINE) if entry.strip()]


@pytest.fixture(scope="module")
def steps(tmp_path_factory: pytest.TempPathFactory) -> set[str]:
    gimbal = CommissionBench(tmp_path_factory.mktemp("rig") / "out.yaml").runner._steps
    return {step.key for step in (*gimbal, *drone_steps(None))}  # type: ignore[arg-type]


def named(text: str) -> list[str]:
    return re.findall(r"`([a-z-]+)`", text)


@pytest.mark.parametrize("unknown", UNKNOWNS)
def test_a_known_unknown_names_its_steps(unknown: str, steps: set[str]) -> None:
    settled_by = UNKNOWNS[unknown]
    if settled_by.startswith("none: "):
        return
    assert named(settled_by)
    assert set(named(settled_by)) <= steps


@pytest.mark.parametrize("entry", OPEN)
def test_what_was_never_tried_names_its_steps(entry: str, steps: set[str]) -> None:
    assert set(named(entry)) & steps, entry


def test_every_step_is_in_the_table_of_the_docs(steps: set[str]) -> None:
    pages = (DOCS / "how-to/commission.md").read_text() + (DOCS / "how-to/drone.md").read_text()
    of_axes = r"`([a-z-]+)-pan`, `-tilt`, `-roll`"
    pages = re.sub(of_axes, lambda found: ", ".join(f"`{found[1]}-{axis}`" for axis in AXES), pages)
    assert {step for step in steps if f"`{step}`" not in pages} == set()


def test_all_of_them_were_read() -> None:
    assert len(UNKNOWNS) > 20
    assert len(OPEN) > 8
