"""What a state has beside its page while a rig is commissioned: no axis is driven, and a STOP is shown until a key."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from teleop.core.axes import Axis
from teleop.manual.status import MessageLog, OperatorStatus, without_hands


class CommissionShown:
    """`stopped_by` is whose STOP came last, "" once somebody has pressed a key since."""

    keys: Sequence[Mapping[str, float]] = ()
    changes = 0
    errors = None
    battery = None

    def __init__(self) -> None:
        self.stopped_by, self.now = "", 0.0
        self._log = MessageLog()

    def line(self, text: str) -> None:
        self._log.notify(self.now, text)

    @property
    def presets(self) -> Mapping[str, Mapping[str, Any]]:
        return {}

    @property
    def focus_marks(self) -> Mapping[str, float]:
        return {}

    @property
    def status(self) -> OperatorStatus:
        return without_hands((), bool(self.stopped_by), False, self._log.messages)

    def drivers(self) -> Mapping[Axis, str]:
        return {}

    def move(self, now: float) -> Mapping[str, Any] | None:  # noqa: ARG002
        return None

    def shoot(self, now: float) -> Mapping[str, Any] | None:  # noqa: ARG002
        return None
