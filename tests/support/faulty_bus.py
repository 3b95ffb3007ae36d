"""A python-can interface whose faults a test decides: the errors that real drivers raise, which no bus here can cause.

Register with `register(monkeypatch)`, then open `faulty:NAME`; `FaultyBus.opened[-1]` is the bus behind the link.
"""

import errno
from collections import deque

import can
from can.interfaces import BACKENDS
from can.interfaces.virtual import VirtualBus


class FaultyBus(VirtualBus):
    opened: list["FaultyBus"] = []  # noqa: RUF012  # python-can makes the instance, so this is how a test finds it

    def __init__(self, channel: str, bitrate: int) -> None:
        super().__init__(channel, bitrate=bitrate)
        self.room = 1 << 30  # CAN frames the queue still takes
        self.send_fault: Exception | None = None
        self.off = False  # it still takes frames into its queue, and none arrives
        self.receive_faults: deque[Exception] = deque()
        self.own_errors: deque[can.Message] = deque()  # as the controller here reports its state; others see nothing
        self.opened.append(self)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        if self.send_fault is not None:
            raise self.send_fault
        if self.room == 0:
            raise driver_fault("Failed to transmit", errno.ENOBUFS)
        self.room -= 1
        if not self.off:
            super().send(msg, timeout)

    def _recv_internal(self, timeout: float | None):
        if self.receive_faults:
            raise self.receive_faults.popleft()
        arrived = super()._recv_internal(timeout)
        if arrived[0] is None and self.own_errors:  # what had arrived before it comes first
            return self.own_errors.popleft(), False
        return arrived


def driver_fault(text: str, number: int) -> can.CanOperationError:
    """As python-can's socketcan raises it: the kernel's error as the cause and its number as the code."""
    fault = can.CanOperationError(text, number)
    fault.__cause__ = OSError(number, text)
    return fault


def register(monkeypatch) -> None:
    monkeypatch.setitem(BACKENDS, "faulty", ("faulty_bus", "FaultyBus"))
    monkeypatch.setattr(FaultyBus, "opened", [])
