"""`type: opentrackio` of a profile's `exchange`: camera tracking by SMPTE RIS-OSVP's OpenTrackIO."""

from __future__ import annotations

import ipaddress
from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from teleop.config.documents.messages import shown
from teleop.config.exchange.address import To
from teleop.config.exchange.tracking import TrackingSection


def _interface(text: str) -> str:
    try:
        ipaddress.IPv4Address(text)
    except ValueError:
        raise ValueError(f"must be this computer's address on that network, not {shown(text)}") from None
    return text


class OpenTrackIOSection(TrackingSection):
    """The camera's measured attitude as OpenTrackIO samples, or what a tracker sends as these."""

    type: Literal["opentrackio"]
    """Camera tracking as OpenTrackIO 1.0.1 over UDP."""
    to: To | None = None
    """HOST:PORT of the receiver; of a multicast group 239.135.1.SOURCE:55555."""
    source: Annotated[int, Field(ge=0, le=4294967295)] = 1
    """The number of the source in the samples; of a tracker, the only one that is followed."""
    encoding: Literal["json", "cbor"] = "json"
    """How samples are written."""
    mtu: Annotated[int, Field(ge=256, le=9000)] = 1500
    """Bytes that a packet of the network has room for: a longer sample goes in segments."""
    interface: Annotated[str, AfterValidator(_interface)] | None = None
    """This computer's IPv4 address on the network that multicast goes to or comes from."""
    ttl: Annotated[int, Field(ge=0, le=255)] = 1
    """Routers that multicast may pass, with this network as the first."""


OUT = ("encoding", "mtu", "ttl")
"""The keys that only an entry that sends has."""
