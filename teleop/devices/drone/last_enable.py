"""When virtual RC was last enabled, kept in a file, so that a run that was killed does not lock the drone by the next.

Enabling it twice within 2 s locks the drone (docs/protocol-facts.md), and a run that has just begun knows nothing of an
enable of the last one. The time is that of the machine's monotonic clock, which all programs share until a reboot, and
that takes longer than 2 s. The file is a few bytes and is not synced: a crash of the machine takes longer as well.
"""

from __future__ import annotations

import math
from pathlib import Path

from teleop.config.folders import state_folder


def default_file() -> Path:
    """Where it is kept. Raises UsageError where there is no home directory."""
    return state_folder("set XDG_STATE_HOME, to note when virtual RC was enabled") / "virtual-rc-enabled"


class LastEnable:
    """The last enable, in `file`."""

    def __init__(self, file: Path) -> None:
        self._file = file

    def read(self, now: float) -> float:
        """The time of the last enable (s), -inf for none; `now` where it cannot be known, so that the wait is kept."""
        try:
            self._file.parent.mkdir(parents=True, exist_ok=True)
            enabled = float(self._file.read_text(encoding="ascii"))
        except FileNotFoundError:
            return -math.inf
        except (OSError, ValueError):
            return now
        return enabled if enabled <= now else -math.inf  # before a reboot

    def write(self, now: float) -> str:
        """Note an enable at `now` (s); why that could not be done, "" when it was."""
        try:
            self._file.write_text(f"{now}\n", encoding="ascii")
        except OSError as error:
            return f"{self._file}: {error.strerror}: after a restart within 2 s of now, wait before engaging"
        return ""
