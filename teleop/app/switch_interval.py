"""The interpreter's switch interval, short while any run of this process goes on, and then as it was found."""

from __future__ import annotations

import sys
import threading

SWITCH_INTERVAL = 0.0005  # s: how long another thread may hold up the control thread


class _SwitchInterval:
    """Entered once for each run: the first makes it short, the last puts it back."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._users = 0
        self._found = 0.0

    def __enter__(self) -> None:
        with self._lock:
            if not self._users:
                self._found = sys.getswitchinterval()
                sys.setswitchinterval(SWITCH_INTERVAL)
            self._users += 1

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._users -= 1
            if not self._users:
                sys.setswitchinterval(self._found)


short_switch_interval = _SwitchInterval()
