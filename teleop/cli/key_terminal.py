"""The terminal whose keys a run may read, and a line where this system has no such keys."""

from __future__ import annotations

import sys
from functools import cache

from teleop.cli.screens.folded import complain
from teleop.inputs.keyboard import has_keys, terminal


def key_terminal() -> int | None:
    """The descriptor of the terminal that this was started on, None where there is none or it has no single keys."""
    if sys.stdin is not None and not sys.stdin.closed and sys.stdin.isatty() and not has_keys():
        _warn()
        return None
    return terminal()


@cache  # once in a run
def _warn() -> None:
    complain("teleop: warning: keys cannot be read on this system: use a pad; Ctrl-C stops")
