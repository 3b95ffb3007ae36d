"""What a check of `teleop doctor` says."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

RULES = "/etc/udev/rules.d/70-teleop.rules"  # before 73, where systemd looks for uaccess
RELOAD = "sudo udevadm control --reload && sudo udevadm trigger"


class State(StrEnum):
    OK = "ok"
    NOTE = "note"  # it works, and could work better
    PROBLEM = "problem"  # something does not work
    FATAL = "fatal"  # nothing does


@dataclass(frozen=True, slots=True)
class Finding:
    """What was looked at, what was found, and what to do about it; `rules` are lines for a udev file."""

    about: str
    state: State
    found: str
    todo: str = ""
    rules: Sequence[str] = field(default_factory=list)


Findings = Iterator[Finding]
