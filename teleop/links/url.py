"""Where a device is reached, as one line of text that a profile, an option and an error message can all carry.

The interface is what stands before the first colon and the channel is everything after it, so that IPv6 groups and
device paths with colons of their own need no quoting. Only the text after the last `@` is a bit rate. The names of
python-can's interfaces are listed here because importing `can` costs a quarter of a second and a profile is checked
on every start; a name that is not listed is looked up in python-can itself, plug-ins included, before it is refused.
"""

from __future__ import annotations

import difflib
from dataclasses import dataclass
from typing import Literal

from teleop.core.errors import UsageError

R_SDK_BITRATE = 1_000_000  # bit/s: DJI R SDK Protocol V2.5, section 3.1, figure 37

CAN_INTERFACES = frozenset(
    [
        *("canalystii", "cantact", "etas", "gs_usb", "iscan", "ixxat", "kvaser", "neousys", "neovi", "nican", "nixnet"),
        *("pcan", "robotell", "seeedstudio", "slcan", "socketcan", "socketcand", "systec", "udp_multicast", "usb2can"),
        *("vector", "virtual"),
    ]
)  # python-can 4.6, without its own `serial`, which here means a plain serial port

_SHAPES = "socketcan:can0, slcan:/dev/ttyACM0, serial:/dev/ttyUSB0@230400 or sim:"


class LinkUrlError(UsageError):
    """A link URL that names nothing this program can open."""


@dataclass(frozen=True, slots=True)
class LinkAddress:
    """A parsed link URL; `str` gives the URL back, without a bit rate that is the default anyway.

    `bitrate` is in bit/s: of the CAN bus, or of the serial line. `sim` has no channel, and a bit rate of 0.
    """

    kind: Literal["can", "serial", "sim"]
    interface: str
    channel: str = ""
    bitrate: int = 0

    def __str__(self) -> str:
        default = {"can": R_SDK_BITRATE, "sim": 0}.get(self.kind)
        return f"{self.interface}:{self.channel}" + ("" if self.bitrate == default else f"@{self.bitrate}")


def parse(url: str) -> LinkAddress:
    """`interface:channel[@bitrate]`, `serial:PORT@BAUD` or `sim:` as an address. Opens nothing.

    Raises LinkUrlError, whose text says what would be right.
    """
    interface, colon, rest = url.partition(":")
    if not colon:
        raise LinkUrlError(f"link {url!r} has no interface: write it as in {_SHAPES}")
    if interface == "sim":
        if rest:
            raise LinkUrlError(f"link {url!r}: the simulated device takes no channel, write sim:")
        return LinkAddress("sim", "sim")
    if interface != "serial" and interface not in CAN_INTERFACES:
        _check_installed(url, interface)
    channel, bitrate = _split_bitrate(url, rest)
    if not channel:
        raise LinkUrlError(f"link {url!r} has no channel: write it as in {_SHAPES}")
    if interface == "serial":
        if bitrate is None:
            raise LinkUrlError(f"link {url!r} has no baud rate: write it as in serial:{channel}@230400")
        return LinkAddress("serial", interface, channel, bitrate)
    return LinkAddress("can", interface, channel, bitrate or R_SDK_BITRATE)


def _split_bitrate(url: str, rest: str) -> tuple[str, int | None]:
    channel, at, text = rest.rpartition("@")
    if not at:
        return rest, None
    if not (text.isascii() and text.isdigit() and len(text) < 10 and int(text) > 0):
        raise LinkUrlError(f"link {url!r}: the bit rate after @ is a whole number of bit/s, not {text!r}")
    return channel, int(text)


def _check_installed(url: str, interface: str) -> None:
    from can.interfaces import VALID_INTERFACES

    if interface in VALID_INTERFACES:
        return
    known = sorted({*VALID_INTERFACES, "serial", "sim"})
    near = difflib.get_close_matches(interface, known, n=3)
    hint = f"did you mean {' or '.join(near)}?" if near else f"there are {', '.join(known)}"
    raise LinkUrlError(f"link {url!r}: no interface {interface!r}; {hint}")
