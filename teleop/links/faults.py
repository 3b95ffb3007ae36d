"""Turns what python-can, pyserial and the kernel raise into one line that says which link, what happened, what to do.

The libraries wrap each other's errors (an unplugged slcan adapter is a CanOperationError from a SerialException raised
while handling an OSError), so the kernel's error number is looked for along the whole chain. It alone picks the advice,
from a table: the same number means the same to every interface, but not the same before and after opening.
"""

from __future__ import annotations

import errno
import os
import socket
from collections.abc import Mapping

from teleop.core.errors import LinkError
from teleop.links.url import LinkAddress

_ANY = ""
_NO_PORT = "no port {channel}: is the adapter plugged in? `teleop devices` lists the ports"
_IN_USE = "{channel} is in use by another program"
_GONE = "the adapter is gone: plug it in, then start again"
_HUNG_UP = "returned no data"  # pyserial's words, without a number, for a port whose device is gone
_UP = "sudo ip link set {channel} up type can bitrate {bitrate}"
_VIRTUAL_UP = "sudo ip link add dev {channel} type vcan; sudo ip link set {channel} up"

_DRIVERS = {"gs_usb": "pip install 'rs-teleop[gs-usb]'"}
_OPENING: Mapping[tuple[str, int], str] = {
    ("socketcan", errno.ENODEV): f"no interface {{channel}}: {_UP}",
    ("vcan", errno.ENODEV): f"no interface {{channel}}: {_VIRTUAL_UP}",
    ("socketcan", errno.EAFNOSUPPORT): "this kernel has no SocketCAN: sudo modprobe can_raw, or use slcan",
    ("vcan", errno.EAFNOSUPPORT): "this kernel has no SocketCAN: use udp_multicast between two programs",
    (_ANY, errno.ENOENT): _NO_PORT,
    (_ANY, errno.EACCES): "not permitted to open {channel}: sudo usermod -a -G dialout $USER, then log in again",
    (_ANY, errno.EAGAIN): _IN_USE,  # pyserial's exclusive lock
    (_ANY, errno.EBUSY): _IN_USE,
}
_RUNNING: Mapping[tuple[str, int], str] = {
    ("socketcan", errno.ENETDOWN): f"{{channel}} is down: {_UP}",
    ("vcan", errno.ENETDOWN): "{channel} is down: sudo ip link set {channel} up",
    ("udp_multicast", errno.ENETUNREACH): "no route for multicast: sudo ip route add 239.0.0.0/8 dev lo",
    (_ANY, errno.ENODEV): _GONE,
    (_ANY, errno.ENXIO): _GONE,
    (_ANY, errno.EIO): _GONE,
}


def system_error(error: BaseException | None) -> OSError | None:
    """The OSError behind an error of python-can or pyserial, one with a number if there is any; None for no OSError."""
    found = None
    while error is not None:
        if isinstance(error, OSError):
            found = error
            if error.errno is not None:
                break
        error = error.__cause__ or error.__context__
    return found


def opening_failed(address: LinkAddress, error: BaseException) -> LinkError:
    """The line for a link that could not be opened."""
    return _explain(address, error, _OPENING)


def driver_missing(address: LinkAddress) -> LinkError:
    """The line for an interface whose package or vendor's library is not on this machine."""
    source = _DRIVERS.get(address.interface, f"python-can's documentation of {address.interface} says what to install")
    return LinkError(f"{address}: its driver is not installed: {source}")


def link_failed(address: LinkAddress, error: BaseException) -> LinkError:
    """The line for a link that was open and works no more."""
    return _explain(address, error, _RUNNING)


def _explain(address: LinkAddress, error: BaseException, advice: Mapping[tuple[str, int], str]) -> LinkError:
    cause = system_error(error)
    if cause is None or cause.errno is None:
        return LinkError(f"{address}: {_GONE if _HUNG_UP in str(error) else _first_line(error)}")
    virtual = address.interface == "socketcan" and address.channel.startswith("vcan")
    family = "vcan" if virtual else address.interface
    text = advice.get((family, cause.errno)) or advice.get((_ANY, cause.errno))
    if address.interface == "socketcan" and cause.errno == errno.ENETDOWN and not _is_there(address.channel):
        text = _GONE  # the kernel takes an interface down before it removes it: which of the two is heard is a race
    if text is None:
        return LinkError(f"{address}: {os.strerror(cause.errno)}")
    return LinkError(f"{address}: {text.format(channel=address.channel, bitrate=address.bitrate)}")


def _is_there(interface: str) -> bool:
    try:
        return socket.if_nametoindex(interface) > 0
    except OSError:
        return False


def _first_line(error: BaseException) -> str:
    return next(iter(str(error).strip().splitlines()), "") or type(error).__name__
