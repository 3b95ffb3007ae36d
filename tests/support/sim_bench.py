"""A simulated gimbal on a bench: talks to it in whole frames and nothing else."""

from collections.abc import Sequence
from typing import Any

from teleop.dji.frame import Frame
from teleop.dji.gimbal.session import Session
from teleop.dji.message import REPLY, Message
from teleop.sim.gimbal.device import SimulatedGimbal


class Bench:
    """`now` is the time on the bench; `unasked` collects the pushes."""

    def __init__(self, **options: Any) -> None:
        self.gimbal = SimulatedGimbal(**options)
        self.host = Session()
        self.now = 0.0
        self.unasked: list[Message] = []

    def tell(self, message: Message) -> None:
        """Sends without waiting for the answer."""
        self.gimbal.receive(self.host.command(message), self.now)

    def ask(self, message: Message) -> Message:
        """The one reply to a request, which comes at once."""
        frame, _ = self.host.request(message, self.now)
        self.gimbal.receive(frame, self.now)
        answers = self.listen()
        assert len(answers) == 1, f"{message} was answered by {answers}"
        return answers[0]

    def ask_raw(self, data: bytes, cmd_type: int = 0x03) -> Sequence[bytes]:
        """The data of the replies to a frame with this data."""
        self.gimbal.receive(Frame(data, cmd_type, 77).encode(), self.now)
        received = self.host.receive(self.gimbal.advance(self.now), self.now)
        replies = [each.frame for each in received if each.frame.cmd_type == REPLY]
        assert all(frame.sequence == 77 for frame in replies)
        return [frame.data for frame in replies]

    def wait(self, seconds: float) -> None:
        self.now += seconds
        assert not self.listen()

    def listen(self) -> list[Message]:
        received = self.host.receive(self.gimbal.advance(self.now), self.now)
        self.unasked += [each.message for each in received if each.request is None]
        return [each.message for each in received if each.request is not None]
