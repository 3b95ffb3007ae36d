"""Waiting for a condition instead of for a time: returns as soon as it holds, fails when it never does."""

import time
from collections.abc import Callable

from teleop.core.errors import LinkError
from teleop.core.interfaces import Link

DEADLINE = 60.0  # s: far beyond any bus and any load here, so that only a real fault reaches it


def wait_until(holds: Callable[[], object], what: str = "condition", patience: float = DEADLINE) -> None:
    deadline = time.monotonic() + patience
    while not holds():
        assert time.monotonic() < deadline, f"{what} never held"
        time.sleep(0.0005)


def collect(link: Link, length: int) -> bytes:
    """The next `length` bytes that arrive, or more if more have."""
    arrived = bytearray()

    def enough() -> bool:
        arrived.extend(link.receive())
        return len(arrived) >= length

    wait_until(enough, f"{length} bytes from {link}")
    return bytes(arrived)


def wait_for_loss(link: Link) -> LinkError:
    """The LinkError with which receiving ends."""
    lost: list[LinkError] = []

    def raises() -> bool:
        try:
            link.receive()
        except LinkError as error:
            lost.append(error)
        return bool(lost)

    wait_until(raises, f"loss of {link}")
    return lost[0]
