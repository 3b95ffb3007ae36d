"""The rules that lie between a profile's sinks, and between them and its links and axes.

A drone's ranges are the protocol's own (docs/protocol-facts.md): too much for a full stick is refused here, in the
file, and not in the air.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from teleop.config.documents.document import Location, Wrong, mapping, number, sequence
from teleop.config.sinks_section import DRONES, MOVES
from teleop.core.axes import STICKS, Axis
from teleop.links.url import LinkUrlError, parse

AXES = frozenset(axis.value for axis in Axis)
MIN_SPEED_RATE = 5  # Hz: a gimbal forgets a speed after 0.5 s


def sink_rules(data: Any) -> Iterator[Wrong]:
    """What is wrong with a profile's sinks beyond their single values; `data` is the whole profile, unchecked."""
    axes = mapping(data, "axes")
    mover: dict[str, int] = {}
    for index, sink in enumerate(sequence(data, "sinks")):
        sink = mapping(sink)
        kind = sink.get("type")
        if isinstance(kind, str) and kind in MOVES:
            yield from _link_rules(sink, index, data)
            yield from _drone_rules(sink, kind, ("sinks", index), data)
            yield from _speed_rules(sink, index, axes)
            yield from _moved_rules(sink, kind, index, axes, mover)
    for axis in axes:
        if axis in AXES and axis not in mover:
            yield ("axes", axis), ": no sink drives it"
    for axis in STICKS:
        low, high = (number(mapping(axes, axis).get(end)) for end in ("min", "max"))
        if axis in axes and not (low is not None and high is not None and -1 <= low < 0 < high <= 1):
            yield ("axes", axis), "is a stick: its min and max must be within -1 and 1, with its center 0 between them"


def _link_rules(sink: Mapping[str, Any], index: int, data: Any) -> Iterator[Wrong]:
    links = mapping(data, "links")
    if isinstance(link := sink.get("link"), str) and link not in links:
        yield ("sinks", index, "link"), f"must be one of the links ({', '.join(links) or 'none'}), not {link!r}"


def _speed_rules(sink: Mapping[str, Any], index: int, axes: Any) -> Iterator[Wrong]:
    rate = number(sink.get("rate"))
    if sink.get("mode") in ("speed", "stick") and rate is not None and rate < MIN_SPEED_RATE:
        yield ("sinks", index, "rate"), f"must be at least {MIN_SPEED_RATE}: a gimbal forgets a speed after 0.5 s"
    for axis, full in mapping(sink, "full_stick").items():
        velocity = number(mapping(axes, axis).get("velocity"))
        if velocity is not None and number(full) is not None and velocity > full:
            yield ("axes", axis, "velocity"), f"must be at most {full:g}, what full stick gives in sinks[{index}]"


def _moved_rules(sink: Mapping[str, Any], kind: str, index: int, axes: Any, mover: dict[str, int]) -> Iterator[Wrong]:
    """The axes that it drives, each by one sink alone; `mover` has the sink of each axis so far."""
    moves = [axis for axis in mapping(sink, "mapping").values() if isinstance(axis, str)] or MOVES[kind]
    moved = [axis for axis in moves if axis in axes]
    if moves and not moved:
        yield ("sinks", index), f": it drives {', '.join(moves)}, and `axes` has none of them"
    for axis in moved:
        if axis in mover:
            yield ("sinks", index), f": {axis} is already driven by sinks[{mover[axis]}]"
        mover[axis] = index


def _drone_rules(sink: Mapping[str, Any], kind: str, here: Location, data: Any) -> Iterator[Wrong]:
    link = sink.get("link")
    if kind not in DRONES or not isinstance(link, str):
        return
    others = [
        other
        for each in sequence(data, "sinks")
        if (other := mapping(each).get("type")) not in DRONES and mapping(each).get("link") == link
    ]
    if others:
        yield (*here, "link"), f"must be the drone's alone, and {others[0]} is on {link} too"
    if _is_bus(mapping(data, "links").get(link)):
        yield ("links", link), "must be a serial line, as a drone's is: serial:/dev/ttyUSB0@230400, or sim:"
    if kind == "flight":
        yield from _flight_rules(sink, here)


def _flight_rules(sink: Mapping[str, Any], here: Location) -> Iterator[Wrong]:
    from teleop.config.flight_modes import FLIGHT_MODES, combination_of  # only a rig that flies needs the protocol

    mode, vertical, yaw = sink.get("mode"), sink.get("vertical", "velocity"), sink.get("yaw", "rate")
    if isinstance(mode, str) and mode in FLIGHT_MODES:
        if vertical not in ("velocity", "height") or yaw not in ("rate", "angle"):
            return
        ranges = combination_of(mode, vertical, yaw).ranges
        for name, of in (("horizontal", "x"), ("vertical", "z"), ("yaw", "yaw")):
            full, most = number(mapping(sink, "full_scale").get(name)), ranges[of].high
            if full is not None and most is not None and full > most:
                yield (*here, "full_scale", name), f"must be at most {most:g} {ranges[of].unit} in this mode"


def _is_bus(url: Any) -> bool:
    try:
        return isinstance(url, str) and parse(url).kind == "can"
    except LinkUrlError:
        return False
