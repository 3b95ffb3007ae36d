"""Moves that came as text: written into the folder of the door for the process that plans, and removed again."""

from __future__ import annotations

import itertools
from shutil import rmtree
from typing import Any

from teleop.door.messages import MOVE_NAME
from teleop.gateway.door_client import DoorClient
from teleop.studio.wire import LARGEST_MOVE

OPTIONS = ("attended", "passes", "speed", "loop")


class SentMoves:
    """`door` is asked to plan them."""

    def __init__(self, door: DoorClient) -> None:
        self._door = door
        self._numbers = itertools.count(1)

    async def load(self, message: dict[str, Any], session: str, name: str) -> dict[str, Any]:
        """Have the move of a message planned and held. The answer has its `duration`, and `ease`: s to its start."""
        title, text = message.pop("title", None), message.pop("text", None)
        options = {key: message.pop(key) for key in OPTIONS if key in message}
        if not isinstance(title, str) or not MOVE_NAME.fullmatch(title):
            return {"error": "title: must be the name of a move", "kind": "invalid"}
        if not isinstance(text, str) or len(text) > LARGEST_MOVE or message:
            return {"error": "must have title, text and options of a move", "kind": "invalid"}
        number = next(self._numbers)
        folder = self._door.address.sent(number)
        try:
            folder.mkdir(parents=True, mode=0o700)
            (folder / f"{title}.yaml").write_text(text, encoding="utf-8")
            play = {"do": "play", "move": title, "sent": number, "held": True, **options}
            return await self._door.command(play, session, name)
        except (OSError, ValueError) as error:  # a text with half of a character is a ValueError
            return {"error": f"{title}: cannot be kept: {error}", "kind": "refused"}
        finally:
            rmtree(folder, ignore_errors=True)
