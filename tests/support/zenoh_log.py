"""What Zenoh itself tells of the states that it did not deliver: each that it dropped, and each link that it closed.

`python_path` is a folder for PYTHONPATH with which every gateway writes Zenoh's log into `folder`, a file for each.
Only what explains a loss is logged: messages that a congested queue has dropped, with their bytes, and closed links.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path
from typing import NamedTuple

FILTER = "zenoh_transport::common::pipeline=trace,zenoh_transport::unicast::universal::transport=debug"
COLORS = re.compile(r"\x1b\[\d+m")
LINE = re.compile(r"(\d{4}-\d\d-\d\dT[\d:.]+Z) ")
CLOSED = re.compile(r"\[(\w+)\] Closing transport with peer: (\w+)")
BYTES = re.compile(r"ZBuf \{ slices: \[\[([0-9a-f, ]+)\]")
HOOK = """
import os, sys
if "teleop.gateway" in sys.orig_argv:
    import zenoh
    os.dup2(os.open(os.path.join({folder!r}, f"{{os.getpid()}}.log"), os.O_WRONLY | os.O_CREAT, 0o600), 1)
    zenoh.try_init_log_from_env()
"""


class Dropped(NamedTuple):
    """`rig` and `seq` of a state that a congested queue has dropped, and when (s, wall clock)."""

    at: float
    rig: str
    seq: int


class Closed(NamedTuple):
    """A link that one side has closed, by the identities of both sessions, and when (s, wall clock)."""

    at: float
    sessions: frozenset[str]


def python_path(folder: Path) -> str:
    """The variables PYTHONPATH and RUST_LOG are for processes that are started with it."""
    hook = folder / "hook"
    hook.mkdir()
    (hook / "sitecustomize.py").write_text(HOOK.format(folder=str(folder)), encoding="utf-8")
    return os.pathsep.join([str(hook), *filter(None, [os.environ.get("PYTHONPATH")])])


def told(folder: Path) -> Iterator[Dropped | Closed]:
    """All that was logged so far."""
    for file in sorted(folder.glob("*.log")):
        with file.open(encoding="utf-8", errors="replace") as lines:
            for line in lines:
                if (found := _event(COLORS.sub("", line))) is not None:
                    yield found


def _event(line: str) -> Dropped | Closed | None:
    if (when := LINE.match(line)) is None:
        return None
    at = datetime.fromisoformat(when[1]).timestamp()
    if (closed := CLOSED.search(line)) is not None:
        return Closed(at, frozenset(closed.groups()))
    if "message dropped" in line and (data := BYTES.search(line)) is not None:
        text = bytes.fromhex(data[1].replace(", ", "")).decode(errors="replace")
        rig, seq = re.search(r'"rig":"([^"]+)"', text), re.search(r'"seq":(\d+)', text)
        if rig is not None and seq is not None:
            return Dropped(at, rig[1], int(seq[1]))
    return None
