"""Asks a gimbal once for its version, for what must say on which gimbal something was measured."""

from __future__ import annotations

from teleop.devices.connection import Answer, Connection
from teleop.dji.gimbal.messages import Version, VersionReply


class VersionQuestion:
    """`version` is "" until the gimbal has answered; not each firmware does. `over` is set once no answer is due."""

    def __init__(self, connection: Connection) -> None:
        self._connection, self._asked = connection, False
        self.version, self.over = "", False
        connection.on_answer(Version, self._answered)

    def ask(self, now: float) -> None:
        """Only the first call asks."""
        if not self._asked:
            self._asked = True
            self._connection.request(Version(), now)

    def _answered(self, answer: Answer) -> None:
        self.over = True
        if isinstance(answer.reply, VersionReply) and not answer.reply.return_code:
            self.version = answer.reply.version
