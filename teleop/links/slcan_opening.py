"""How an slcan adapter is taken onto its bus, one that resets itself when its port is opened included.

Every Arduino with DTR and most ESP32 boards do: for a second or two they are deaf, and what was sent is lost. So the
opening (C closes, S8 sets 1 Mbit/s, O opens) is repeated until an adapter acknowledges S and O in one round, for 3 s at
most. Many adapters never acknowledge anything: frames that arrive after O prove as much, since a bus at another bit
rate has none. They prove nothing in a round in which the adapter refused S or O: some count damaged frames as frames,
and an adapter that was open before sends what it had received. The answer to C does not matter: an adapter that is
closed already refuses it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Protocol

from teleop.core.errors import LinkError
from teleop.links.url import LinkAddress

ANSWER_TIMEOUT = 3.0  # s in which an adapter has to answer
ANSWER = 0.2  # s for the answer to one command
QUIET = 0.03  # s without a line after which an answer is the last one
LOOK = 0.005  # s between looks for an answer
REFUSALS = 3  # rounds in a row that are refused: one may be what a reset left behind
ACKNOWLEDGEMENTS = (b"", b"z", b"Z")


class Opening(Protocol):
    """What an adapter offers while it is opened."""

    def command(self, text: bytes) -> None: ...

    def replies(self) -> Iterator[tuple[bytes, bool]]:
        """The lines that have arrived, and whether each refuses."""
        ...

    def hear(self, line: bytes) -> bool:
        """Keep a line; whether it is a CAN frame."""
        ...


class _Exchange:
    """Commands and their answers, timed by how long was waited for them: `wait` sleeps so many s."""

    def __init__(self, adapter: Opening, wait: Callable[[float], object]) -> None:
        self._adapter, self._wait = adapter, wait
        self.waited = 0.0

    def ask(self, command: bytes) -> bool | None:
        """Whether the adapter acknowledges, None when it does not answer."""
        self._adapter.command(command)
        return self._answer(ANSWER)

    def settle(self, command: bytes) -> None:
        """Send a command, whose answers, however many, do not matter."""
        self._adapter.command(command)
        if self._answer(ANSWER) is not None:
            while self._answer(QUIET) is not None and self.waited < ANSWER_TIMEOUT:
                pass

    def frames(self, command: bytes) -> tuple[bool | None, bool]:
        """What `ask` says of a command, and whether CAN frames arrive after it."""
        self._adapter.command(command)
        answer, end, framed = None, self.waited + ANSWER, False
        while self.waited < end and answer is None:
            for line, refused in self._adapter.replies():
                if not refused and self._adapter.hear(line) and not framed:
                    framed, end = True, min(end, self.waited + QUIET)  # a refusal may still be on its way
                if refused or line in ACKNOWLEDGEMENTS:
                    answer = not refused
            self._pause()
        return answer, framed

    def _answer(self, patience: float) -> bool | None:
        end = self.waited + patience
        while self.waited < end:
            self._pause()
            for line, refused in self._adapter.replies():
                if refused or line in ACKNOWLEDGEMENTS:
                    return not refused
        return None

    def _pause(self) -> None:
        self._wait(LOOK)
        self.waited += LOOK


def go_on_bus(adapter: Opening, address: LinkAddress, speed: int, wait: Callable[[float], object]) -> None:
    """Open the adapter at bit rate number `speed` (S0 .. S8); `wait` sleeps so many s.

    Raises LinkError when it does not answer or refuses, and OSError as its port does.
    """
    exchange, refused, rounds = _Exchange(adapter, wait), "", 0
    while exchange.waited < ANSWER_TIMEOUT:
        exchange.settle(b"\rC\r")  # CR: an earlier run's torn line
        set_speed = exchange.ask(b"S%d\r" % speed)
        opened, framed = exchange.frames(b"O\r")
        refuses = False in (set_speed, opened)
        if (framed and not refuses) or (set_speed and opened):
            return
        if refuses:
            refused = f"S{speed} ({address.bitrate} bit/s)" if set_speed is False else "O (open)"
            rounds += 1
            if rounds >= REFUSALS:
                break
        else:
            rounds = 0
    if refused:
        raise LinkError(
            f"{address}: the adapter refuses {refused}: plug it in again, or use an adapter that has this bit rate"
        )
    raise LinkError(f"{address}: the adapter does not answer: does it speak slcan, at this baud rate? Plug it in again")
