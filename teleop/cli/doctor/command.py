"""`teleop doctor`: what this machine can do, what is in the way, and what to do about it.

A check is a function that looks at one thing and says a line or more; none of them can fail, because what cannot be
looked at is itself an answer. Only what makes every run impossible is a failure of the doctor: a machine without a pad
still plays sequences.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import Annotated

from cyclopts import Parameter

from teleop.cli.doctor.devices import can_adapters, hid, serial
from teleop.cli.doctor.event_pads import event_pads
from teleop.cli.doctor.finding import Finding, Findings, State
from teleop.cli.doctor.machine import disk, packages, python, terminal
from teleop.cli.doctor.responses import kept_responses, responses
from teleop.cli.doctor.timing import lateness, scheduling
from teleop.cli.screens.response_lines import kept_facts

CHECKS: Sequence[Callable[[], Findings]] = (
    python, packages, hid, event_pads, serial, can_adapters, scheduling, lateness, disk, terminal, responses
)  # fmt: skip


def doctor(*, as_json: Annotated[bool, Parameter(name="--json", negative="", show_default=False)] = False) -> int:
    """Check what this machine can do: packages, permissions, adapters, timing, room for takes; show what is kept.

    Parameters
    ----------
    as_json
        One JSON object, for programs.
    """
    findings = [finding for check in CHECKS for finding in check()]
    if as_json:
        found = {"ok": not _fatal(findings), "findings": [asdict(each) for each in findings]}
        print(json.dumps({**found, "responses": [*map(kept_facts, kept_responses()[0])]}))
    else:
        _print(findings)
    return 1 if _fatal(findings) else 0


def _fatal(findings: Sequence[Finding]) -> bool:
    return any(finding.state is State.FATAL for finding in findings)


def _print(findings: Sequence[Finding]) -> None:
    """A line for each finding, what to do beneath it, and udev's lines by themselves, ready to be copied."""
    marks = {State.OK: "ok", State.NOTE: "--", State.PROBLEM: "!!", State.FATAL: "XX"}
    for each in findings:
        print(f"{marks[each.state]}  {each.about:<10} {each.found}" + (f": {each.todo}" if each.todo else ""))
        for rule in each.rules:
            print(rule)
    worst = [each for each in findings if each.state in (State.PROBLEM, State.FATAL)]
    print(f"{len(worst)} {'thing is' if len(worst) == 1 else 'things are'} in the way" if worst else "ready")
