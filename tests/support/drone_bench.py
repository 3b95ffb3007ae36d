"""A simulated drone on a bench: talks to it in whole frames and nothing else."""

from __future__ import annotations

from typing import Any, Self

from teleop.dji.drone import messages as drone
from teleop.dji.drone.broadcast import Broadcast
from teleop.dji.drone.enums import ControlCode, ControlOrder
from teleop.dji.drone.session import OnboardSession
from teleop.dji.gimbal.session import Received
from teleop.dji.message import Message
from teleop.sim.drone.device import SimulatedDrone

LOOK = 0.005  # s between looks


class DroneBench:
    """`heard` are the broadcasts with their times, `pushes` what else came unasked, `received` everything."""

    def __init__(self, **settings: Any) -> None:
        self.now = 0.0
        self.drone = SimulatedDrone(**settings)
        self.session = OnboardSession()
        self.heard: list[tuple[float, Broadcast]] = []
        self.pushes: list[Message] = []
        self.received: list[Received] = []

    @classmethod
    def activated(cls, **settings: Any) -> Self:
        bench = cls(**settings)
        bench.ask(drone.Activate(1))
        return bench

    def send(self, data: bytes) -> None:
        """Bytes, and what comes back at once."""
        self.drone.receive(data, self.now)
        self._listen()

    def tell(self, message: Message) -> None:
        self.send(self.session.command(message))

    def ask(self, message: Message) -> Any:
        """A request's acknowledgement."""
        self.send(self.session.request(message, self.now)[0])
        [answer] = [each.message for each in self.received if each.request is message]
        return answer

    def obtain(self) -> None:
        """Control, which has to be asked for twice."""
        codes = [self.ask(drone.Control(ControlOrder.OBTAIN)).code for _ in range(2)]
        assert codes == [ControlCode.OBTAINING, ControlCode.OBTAINED]

    def run(self, seconds: float) -> None:
        end = self.now + seconds
        while self.now < end - 1e-9:
            self.now = min(self.now + LOOK, end)
            self._listen()

    def hold(self, message: Message, seconds: float, rate: float = 20) -> None:
        """Send the same over and over."""
        for _ in range(round(seconds * rate)):
            self.tell(message)
            self.run(1 / rate)

    def last(self, part: str) -> Any:
        return next(value for _, each in reversed(self.heard) if (value := getattr(each, part)) is not None)

    def _listen(self) -> None:
        for received in self.session.receive(self.drone.advance(self.now), self.now):
            self.received.append(received)
            if isinstance(received.message, Broadcast):
                self.heard.append((self.now, received.message))
            elif not received.frame.is_reply:
                self.pushes.append(received.message)
        for frame in self.session.due(self.now):
            self.drone.receive(frame, self.now)
