"""OpenTrackIO out: a sample for each slot of time, with what does not change every 2 s."""

from __future__ import annotations

import platform
import time
from collections.abc import Mapping
from importlib.metadata import version
from typing import Any

from teleop.config.exchange.opentrackio import OpenTrackIOSection
from teleop.exchange.attitude import Attitude, AttitudeFeed
from teleop.exchange.opentrackio.packets import CBOR, HEADER, JSON, packets
from teleop.exchange.opentrackio.sample import Moment, Pose, Source, encoded, identity, sample
from teleop.exchange.served import Served
from teleop.exchange.udp import UdpSender, udp_sender
from teleop.studio.clocks import clock_error

STATIC = 2.0  # s between two samples with what does not change


async def send(section: OpenTrackIOSection, to: str, served: Served) -> None:
    """A sample for each slot of time, each of the instant `latency` before its slot."""
    name = f"opentrackio to {to}"
    feed = AttitudeFeed(served, name, section.latency)
    sender = await udp_sender(to, name, served.notify, section.interface, section.ttl)
    served.notify(
        f"{name}: source {section.source}, {section.rate:g} samples a second, each of {section.latency * 1000:g} ms"
        " before"
    )
    samples = Samples(section, served.rig.name, sender)
    x, y, z = section.position

    def pass_on(instant: float, at: Attitude) -> None:
        samples.send(instant, Pose(x, y, z, at.pan, at.tilt, at.roll), at.focus, _status(feed.state))

    try:
        await feed.each(section.rate, pass_on)
    finally:
        sender.close()


class Samples:
    """Numbers, encodes and sends samples."""

    def __init__(self, section: OpenTrackIOSection, rig: str, sender: UdpSender) -> None:
        own = identity(platform.node(), rig, section.source)
        self._source = Source(section.source, own, section.rate, rig, version("rs-teleop"))
        self._encoding = CBOR if section.encoding == "cbor" else JSON
        self._room = section.mtu - sender.header - HEADER.size
        self._sender = sender
        self._number = 0
        self._packet = 1  # SMPTE's receiver takes a first packet 0 for one that it had
        self._static_at = -STATIC
        self._locked = False

    def send(self, instant: float, pose: Pose, focus: float | None, status: str) -> None:
        """`instant` is by the monotonic clock, in s."""
        with_static = instant - self._static_at >= STATIC
        if with_static:
            self._static_at, self._locked = instant, clock_error() is not None
        moment = Moment(instant + time.time() - time.monotonic(), self._number, self._locked)
        data = encoded(sample(self._source, moment, pose, focus, status, with_static), self._encoding)
        for packet in packets(data, self._encoding, self._packet, self._room):
            self._sender.send(packet)
            self._packet = (self._packet + 1) & 0xFFFF
        self._number += 1


def _status(state: Mapping[str, Any]) -> str:
    return "stopped" if state.get("stopped") else "measured"
