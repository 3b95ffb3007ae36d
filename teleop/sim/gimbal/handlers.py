"""How the parts of a simulated gimbal say which messages they obey: a table from message class to what it does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from teleop.dji.message import Message, ReturnCode

Answer = Message | ReturnCode  # a return code stands for the reply that has nothing else
Handler = Callable[[Any, float], Answer]  # of a message of the class it stands under, and the time in s
Handlers = dict[type[Message], Handler]


def timeless(obey: Callable[[Any], Answer]) -> Handler:
    """A handler for which it does not matter when the message comes."""
    return lambda message, _now: obey(message)


def without_reserved(message: Message) -> Message:
    """The message as if its reserved bits were zero: clients set them, and real devices do not look at them."""
    return replace(message, reserved=0) if getattr(message, "reserved", 0) else message  # type: ignore[call-arg]
