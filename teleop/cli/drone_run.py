"""Asks before a script flies a drone: on the command line or by a typed word, before any port is opened."""

from __future__ import annotations

import sys
from collections.abc import Collection
from typing import Annotated

from cyclopts import Parameter

from teleop.app.drone_flight import is_flown
from teleop.core.axes import Axis
from teleop.core.errors import UsageError

WORD = "fly"
Understood = Annotated[
    bool,
    Parameter(
        name="--i-understand",
        help="Fly a drone without confirmation: its sticks are engaged at the start.",
        negative=(),
        show_default=False,
    ),
]


def ask_to_fly(what: str, axes: Collection[Axis], understood: bool) -> None:
    """Raises UsageError where `what` moves a drone without the operator's consent."""
    if not is_flown(axes) or understood:
        return
    if sys.stdin is None or sys.stdin.closed or not sys.stdin.isatty():
        raise UsageError(f"{what} flies a drone: run it on a terminal to confirm, or give --i-understand")
    print(f"{what} flies a drone. Its pilot has the RC in hand, in F? Type {WORD} and Enter: ", end="", file=sys.stderr)
    sys.stderr.flush()
    if sys.stdin.readline().strip().lower() != WORD:
        raise UsageError(f"{what}: {WORD} was not typed; nothing was sent to the drone")
