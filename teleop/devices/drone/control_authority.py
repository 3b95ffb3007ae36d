"""Control of the drone's movement (01 00): obtained and released, and known only by an answer or the broadcast.

The drone needs each order twice: "the first ACK will be fail" (OPENProtocol.md 3.1.9, 01 00), which is 3 for obtain
and 4 for release. So an order is sent again after each such answer, and after none, with a pause each time. Obtaining
ends with whoever asked for it: the engagement waits `patience` for it. Releasing ends when it is confirmed, or when
control is obtained again.

An answer counts only for the newest order: one that comes late may be the answer to an older one.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from teleop.devices.connection import Answer, Connection
from teleop.devices.drone.control_mode import word_of
from teleop.devices.drone.telemetry import FRESH, Telemetry
from teleop.dji.drone import messages as drone
from teleop.dji.drone.enums import ControlCode, ControlDevice, ControlOrder

AGAIN = 0.1  # s from an answer that asks for a repetition to the repetition
REPEAT = 0.5  # s from no answer, or one that means nothing here, to the next release
ORDER_TIMEOUT = 3.0  # s for two orders, each sent twice 0.5 s apart (docs/protocol-facts.md), with their answers
IN_PROGRESS = (ControlCode.OBTAINING, ControlCode.RELEASING)


class ControlAuthority:
    """Control over one connection. `notify` is for what the operator has to know."""

    def __init__(self, connection: Connection, notify: Callable[[str], object]) -> None:
        self._connection, self._notify = connection, notify
        self._order: ControlOrder | None = None  # the newest one
        self._sequence = -1  # of its last request
        self._since = self._ask_at = math.inf  # s: first sent, to be sent
        self._pause: float | None = None  # s from the last answer to the next request
        self._answer: ControlCode | None = None  # that settles the newest order
        self._refused = False
        connection.on_answer(drone.Control, self._answered)

    @property
    def patience(self) -> float:
        """How long obtaining may take (s); nothing once it is refused."""
        return 0.0 if self._refused else ORDER_TIMEOUT

    def obtain(self, now: float) -> None:
        """Raises LinkError."""
        self._begin(ControlOrder.OBTAIN, now)

    def release(self, now: float) -> None:
        """Raises LinkError."""
        self._begin(ControlOrder.RELEASE, now)

    def service(self, now: float) -> None:
        """Send the newest order again where that is due; to be called each tick. Raises LinkError."""
        if self._pause is not None:
            self._ask_at, self._pause = now + self._pause, None
        if self._order is not None and now >= self._ask_at:
            self._send(self._order, now)

    def cancel(self) -> None:
        """Send nothing again: who asked for it has left."""
        self._ask_at, self._pause = math.inf, None
        self._connection.withdraw(drone.Control)

    def obtained(self, seen: Telemetry, now: float) -> bool:
        """Whether movement commands are obeyed, as far as the drone says."""
        return self._order == ControlOrder.OBTAIN and (
            self._answer == ControlCode.OBTAINED or self._device(seen, now) == ControlDevice.ONBOARD_DEVICE
        )

    def held(self, seen: Telemetry, now: float) -> bool | None:
        """Whether the drone says that this program has control; None where it does not say.

        Its control device decides where it is broadcast. After a release only what came later than that counts.
        """
        device = self._device(seen, now)
        if self._order == ControlOrder.RELEASE:
            if self._answer == ControlCode.RELEASED:
                return False
            return None if device is None else device == ControlDevice.ONBOARD_DEVICE
        if device is not None:
            return device == ControlDevice.ONBOARD_DEVICE
        return self._answer == ControlCode.OBTAINED

    def still_held(self, seen: Telemetry, now: float) -> bool:
        """Whether the broadcast contradicts a release that was confirmed: an older obtain has arrived late."""
        return self._order == ControlOrder.RELEASE and self._device(seen, now) == ControlDevice.ONBOARD_DEVICE

    def _device(self, seen: Telemetry, now: float) -> object:
        control = seen.get("control", now, min(FRESH, now - self._since))
        return None if control is None else control.device

    def _begin(self, order: ControlOrder, now: float) -> None:
        self._order, self._since, self._answer, self._refused = order, now, None, False
        self._ask_at, self._pause = now, None  # until it has left
        self._send(order, now)

    def _send(self, order: ControlOrder, now: float) -> None:
        self._sequence = self._connection.request(drone.Control(order), now)
        self._ask_at = math.inf

    def _answered(self, answer: Answer) -> None:
        if answer.sequence != self._sequence or self._order is None:
            return
        code = getattr(answer.reply, "code", None)
        if code in IN_PROGRESS:
            self._pause = AGAIN
        elif code == _settles(self._order):
            self._answer = ControlCode(code)
        elif self._order == ControlOrder.RELEASE:  # the engagement reports whether it is confirmed
            self._pause = REPEAT
        elif code is None:
            self._pause = REPEAT
            self._notify("the drone did not answer when asked about control")
        else:
            self._refused = True
            self._notify(f"the drone refuses control: {word_of(code)}")


def _settles(order: ControlOrder) -> ControlCode:
    return ControlCode.OBTAINED if order == ControlOrder.OBTAIN else ControlCode.RELEASED
