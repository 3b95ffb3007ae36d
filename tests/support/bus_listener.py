"""A third node on a kernel's CAN bus: the angles that the gimbal reports, with the kernel's own times."""

from __future__ import annotations

import time
from collections.abc import Callable
from types import TracebackType
from typing import NamedTuple, Self

import can

from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.session import Session
from teleop.dji.message import Message
from teleop.links.can import GIMBAL_ID

PATIENCE = 60.0  # s: two processes start on an emulated computer before the first frame comes
_LOOK = 0.1  # s without a frame after which a condition is looked at anyway


class Angle(NamedTuple):
    """Where the gimbal said that its pan was: s of the kernel's clock, deg."""

    time: float
    pan: float


class BusListener:
    """Hears what is said while it waits for something; `angles` has the gimbal's answers since it was opened."""

    def __init__(self, channel: str) -> None:
        self.angles: list[Angle] = []
        self._bus = can.Bus(channel, interface="socketcan", ignore_config=True)
        self._ends = {GIMBAL_ID: Session()}

    def until(self, holds: Callable[[], object], what: str, evidence: object = "") -> None:
        """Returns as soon as it holds, and fails when it never does."""
        deadline = time.monotonic() + PATIENCE
        while not holds():
            assert time.monotonic() < deadline, f"{what} never came: {self.angles[-5:]} {evidence}"
            self._hear()

    def more(self, count: int) -> list[Angle]:
        """The next angles that the gimbal tells."""
        begin = len(self.angles)
        self.until(lambda: len(self.angles) >= begin + count, f"{count} more angles")
        return self.angles[begin:]

    @property
    def pan(self) -> float:
        """Where the pan was last said to be (deg); NaN before."""
        return self.angles[-1].pan if self.angles else float("nan")

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bus.shutdown()

    def _hear(self) -> None:
        heard = self._bus.recv(timeout=_LOOK)
        if heard is not None and heard.arbitration_id in self._ends:
            for received in self._ends[heard.arbitration_id].receive(bytes(heard.data), heard.timestamp):
                self._note(heard.timestamp, received.message)

    def _note(self, moment: float, message: Message) -> None:
        if isinstance(message, gimbal.AnglesReply) and not message.return_code:
            self.angles.append(Angle(moment, message.yaw))
