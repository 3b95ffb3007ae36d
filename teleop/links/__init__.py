"""Links carry bytes to a device and back, and know nothing of what they mean.

Each transport is a row in a table and is imported when it is opened: python-can costs a quarter of a second, which a
simulated run need not pay. `sim:` is not here, because the simulator stands above the links; the rig opens it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import Any, Final, Protocol

from teleop.core.interfaces import Link
from teleop.links.url import LinkAddress, LinkUrlError, parse

__all__ = [
    "FAR_END",
    "NEAR_END",
    "ClosableLink",
    "LinkAddress",
    "LinkUrlError",
    "Listener",
    "OpenLink",
    "open_link",
    "open_listener",
    "parse",
]

FAR_END: Final = 0  # the sender on a serial line, which has no CAN ids
NEAR_END: Final = 1


class ClosableLink(Link, Protocol):
    """A link that has to be closed; closing twice is fine."""

    def close(self) -> None: ...


class OpenLink(ClosableLink, Protocol):
    """A link to a port; `counts` has what went wrong without the link being lost, by name."""

    counts: Counter[str]


def open_link(address: str | LinkAddress, *, host: bool = True, now: Callable[[], float]) -> OpenLink:
    """Opens a link URL or a parsed one; `host=False` is the device's end of a CAN bus. `now` is a clock in seconds.

    Raises LinkUrlError for a URL that names nothing to open, LinkError when it cannot be opened.
    """
    if isinstance(address, str):
        address = parse(address)
    opener = _OPENERS.get(address.kind)
    if opener is None:
        raise LinkUrlError(f"link {str(address)!r} is simulated in this process: there is no port to open")
    return opener(address, host, now)


class Listener(Protocol):
    """Hears what others say. `foreign` counts those who are not of interest, `counts` what went wrong, by name."""

    foreign: Counter[int]
    counts: Counter[str]

    def receive(self) -> list[tuple[int, bytes]]:
        """What has arrived since the last call, by sender: a CAN id, or FAR_END. Raises LinkError once it is lost."""
        ...

    def close(self) -> None: ...


def open_listener(
    address: str | LinkAddress, *, now: Callable[[], float], tap: Callable[[Any], object] | None = None
) -> Listener:
    """Opens a link to hear what host and device say to each other. `now` is a clock in seconds.

    `tap` is called with all that arrives: each BusFrame of a CAN bus, the bytes of a serial line.

    Raises LinkUrlError where there is nothing to hear, LinkError when it cannot be opened.
    """
    if isinstance(address, str):
        address = parse(address)
    if address.kind == "can":
        from teleop.links.can import CanListener

        return CanListener(address, now=now, tap=tap)
    if address.kind == "serial":
        from teleop.links.serial import SerialListener

        return SerialListener(address, now=now, tap=tap)
    raise LinkUrlError(f"link {str(address)!r} is simulated in each process: there is nothing to listen on")


def _open_can(address: LinkAddress, host: bool, now: Callable[[], float]) -> OpenLink:
    from teleop.links.can import GIMBAL_ID, HOST_ID, CanLink

    transmit, receive = (HOST_ID, GIMBAL_ID) if host else (GIMBAL_ID, HOST_ID)
    return CanLink(address, transmit, receive, now=now)


def _open_serial(address: LinkAddress, host: bool, now: Callable[[], float]) -> OpenLink:  # noqa: ARG001
    from teleop.links.serial import SerialLink

    return SerialLink(address, now=now)


_OPENERS: dict[str, Callable[[LinkAddress, bool, Callable[[], float]], OpenLink]] = {
    "can": _open_can,
    "serial": _open_serial,
}
