"""Tells the operator, once each, what is wrong with the links of a run without ending it."""

from __future__ import annotations

from collections.abc import Callable, Collection

from teleop.core.events import Tick
from teleop.devices.connection import Connection


class LinkNotes:
    """An observer; `notify` gets each warning as it comes up."""

    def __init__(self, connections: Collection[Connection], notify: Callable[[str], object]) -> None:
        self._connections, self._notify = connections, notify
        self._known: set[str] = set()

    def observe(self, tick: Tick) -> None:  # noqa: ARG002 - only that time has passed
        for connection in self._connections:
            for warning in connection.warnings:
                if warning not in self._known:
                    self._known.add(warning)
                    self._notify(warning)
