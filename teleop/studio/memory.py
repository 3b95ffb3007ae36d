"""Which rigs were seen, for commands that come later: one that is lost stays in the list for a day."""

from __future__ import annotations

import json
import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from teleop.config.files import OutputError, write_text
from teleop.config.folders import state_folder
from teleop.core.errors import UsageError

KEPT = 86_400.0  # s
MOST = 500  # rigs


def memory_file() -> Path | None:
    """Where it is kept; None where the user has no home."""
    try:
        return state_folder("") / "fleet" / "rigs.json"
    except UsageError:
        return None


def recalled(file: Path | None) -> dict[str, float]:
    """When each rig was last seen, by the wall clock (s). A file that is no memory is none."""
    if file is None:
        return {}
    try:
        found = json.loads(file.read_text(encoding="utf-8"))["rigs"]
        seen = {str(name): float(at) for name, at in found.items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return {}
    return {name: at for name, at in seen.items() if time.time() - at < KEPT}


def remember(file: Path | None, seen: Mapping[str, float]) -> None:
    """Add what was seen; where that cannot be written, it is not remembered."""
    if file is None or not seen:
        return
    newest = sorted({**recalled(file), **seen}.items(), key=lambda item: -item[1])[:MOST]
    with suppress(OSError, OutputError):
        file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        write_text(file, json.dumps({"rigs": dict(newest)}))
