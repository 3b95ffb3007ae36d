"""The other end of a memory link, in a few lines: keeps what arrives, and answers what it has a reply for."""

from __future__ import annotations

from collections.abc import Callable

from teleop.devices.connection import Connection
from teleop.dji.gimbal.session import Session
from teleop.dji.message import Message
from teleop.links.memory import pair


class FarEnd:
    """`replies` maps a kind of request to what is answered to it; what is not in it, or None, is not."""

    def __init__(self) -> None:
        here, there = pair()
        self.connection = Connection("the gimbal", "memory:", here, 0.0)
        self.here, self.link = here, there
        self.replies: dict[type[Message], Callable[[Message], Message | None]] = {}
        self.heard: list[Message] = []
        self._session = Session()

    def push(self, message: Message) -> None:
        self.link.send(self._session.command(message))

    def serve(self, now: float) -> list[Message]:
        """Take in what was sent, answer it, and return it."""
        received = self._session.receive(self.link.receive(), now)
        for each in received:
            reply = self.replies.get(type(each.message), lambda _message: None)(each.message)
            if reply is not None:
                self.link.send(self._session.reply(each.frame, reply))
        messages = [each.message for each in received]
        self.heard += messages
        return messages
