"""A rig described in YAML, checked whole before any port opens.

pydantic checks each value; the rules of this module check what lies between values (a sink's link exists, every axis
is moved by exactly one sink). The rules read the plain data, not the checked model, so that they still speak when
some value is wrong and a file's errors come all at once. Angles are degrees, focus is 0..1; magnitudes are per
second, per second squared and per second cubed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, Literal

from pydantic import Field

from teleop.document import Document, DocumentError, Wrong, mapping, number, read_document, sequence
from teleop.links.url import LinkUrlError, parse
from teleop.motion import Axis, Limits
from teleop.section import Finite, Section
from teleop.shipped import find
from teleop.sources.handling import PresetsSection, SticksSection
from teleop.sources.inputs_section import InputSection, input_rules

MOVES: Mapping[str, Sequence[Axis]] = {
    "gimbal": (Axis.PAN, Axis.TILT, Axis.ROLL),  # unless its mapping says otherwise
    "focus": (Axis.FOCUS,),
    "camera": (),
}
"""The axes that each type of sink can move."""

AXES = frozenset(axis.value for axis in Axis)
MIN_SPEED_RATE = 5  # Hz: a gimbal forgets a speed after 0.5 s

Magnitude = Annotated[float, Field(gt=0, allow_inf_nan=False)]
Share = Annotated[float, Field(gt=0, le=1)]
Rate = Literal[1, 2, 4, 5, 10, 20, 25, 50, 100]  # Hz: whole numbers of the loop's ticks
Angle = Literal["pan", "tilt", "roll"]
AxisName = Annotated[Axis, Field(strict=False)]


class AxisSection(Section):
    """One axis: its soft limits, null for none, and the most it may do."""

    min: Finite | None
    max: Finite | None
    velocity: Magnitude
    acceleration: Magnitude
    jerk: Magnitude

    def limits(self) -> Limits:
        low = -math.inf if self.min is None else self.min
        high = math.inf if self.max is None else self.max
        return Limits(low, high, self.velocity, self.acceleration, self.jerk)


class GainsSection(Section):
    """How hard the measured error is worked against: deg/s per deg, and deg/s2 per deg; 0 does not."""

    proportional: Annotated[float, Field(ge=0, le=20)] = 3.0
    integral: Annotated[float, Field(ge=0, le=20)] = 2.0


class GimbalSection(Section):
    """Pan, tilt and roll over the R SDK.

    `delay` is how much later than commanded the gimbal moves, in s. `signs` turns an axis whose firmware counts the
    other way. `mapping` says which axis each of the gimbal's angles is; one that is left out is not driven.
    `gains` are those of the modes speed and stick. `follow` is how far from commanded an axis may stay, in deg.
    `full_stick` is what full deflection gives with the gimbal's own joystick settings, in deg/s, for mode stick; an
    axis that is not named there reaches its velocity.
    """

    type: Literal["gimbal"]
    link: str
    mode: Literal["position", "speed", "stick"]
    rate: Rate
    delay: Annotated[float, Field(ge=0, le=0.5)] = 0.0
    gains: GainsSection = GainsSection()
    follow: Annotated[float, Field(gt=0, le=180)] = 5.0
    signs: dict[Angle, Literal[1, -1]] = Field(default_factory=dict)
    mapping: dict[Literal["yaw", "roll", "pitch"], Angle] = Field(
        default_factory=lambda: {"yaw": "pan", "roll": "roll", "pitch": "tilt"}
    )

    full_stick: dict[Angle, Magnitude] = Field(default_factory=dict)

    @property
    def axes(self) -> Sequence[Axis | None]:
        """The axes of the gimbal's yaw, roll and pitch."""
        mapped = (self.mapping.get(name) for name in ("yaw", "roll", "pitch"))
        return [None if axis is None else Axis(axis) for axis in mapped]

    def full(self, axis: Axis, velocity: float) -> float:
        """What full deflection gives an axis whose own velocity is `velocity`, both in deg/s."""
        return {Axis(name): full for name, full in self.full_stick.items()}.get(axis, velocity)


class FocusSection(Section):
    """The focus motor on the gimbal's bus. `follow` is how far from commanded it may be found for long."""

    type: Literal["focus"]
    link: str
    rate: Rate
    follow: Share = 0.1


class CameraSection(Section):
    """The camera that the gimbal controls: record, stop, shutter."""

    type: Literal["camera"]
    link: str


class ShootingSection(Section):
    """How a timelapse is shot on this rig: `wait_for_link` waits for a lost link and goes on by itself."""

    wait_for_link: bool = False


class Profile(Section):
    """A rig. `links` are URLs by the names that sinks use; sinks are served in their order."""

    name: Annotated[str, Field(min_length=1)]
    links: dict[str, str]
    axes: Annotated[dict[AxisName, AxisSection], Field(min_length=1)]
    sinks: list[Annotated[GimbalSection | FocusSection | CameraSection, Field(discriminator="type")]]
    sticks: SticksSection = SticksSection()
    presets: PresetsSection = PresetsSection()
    inputs: list[InputSection] = Field(default_factory=list)
    timelapse: ShootingSection = ShootingSection()

    @property
    def limits(self) -> Mapping[Axis, Limits]:
        return {axis: section.limits() for axis, section in self.axes.items()}


def load_profile(name: str, links: Mapping[str, str] | None = None) -> Profile:
    """The profile called `name`, shipped or at a path, with the URLs of some of its `links` replaced.

    Raises DocumentError with a line for everything wrong with it.
    """
    document = read_document(*find(name, "profiles", "rig"))
    profile = document.check(Profile, _rules(document.data))
    return _with_links(profile, document, links or {})


def _rules(data: Any) -> Iterator[Wrong]:
    for name, section in mapping(data, "axes").items():
        yield from _axis_rules(name, section)
    for name, url in mapping(data, "links").items():
        if isinstance(url, str) and (wrong := _url_error(url)):
            yield ("links", name), wrong
    yield from _sink_rules(data)
    yield from input_rules(data)


def _axis_rules(name: str, section: Any) -> Iterator[Wrong]:
    section = mapping(section)
    low, high = section.get("min"), section.get("max")
    if "min" in section and "max" in section and (low is None) != (high is None):
        yield ("axes", name, "min"), "and max must both be numbers, or both null for a continuous axis"
    if number(low) is not None and number(high) is not None and low >= high:
        yield ("axes", name, "min"), f"must be less than max ({high:g})"


def _sink_rules(data: Any) -> Iterator[Wrong]:
    links, axes = mapping(data, "links"), mapping(data, "axes")
    mover: dict[str, int] = {}
    for index, sink in enumerate(sequence(data, "sinks")):
        sink = mapping(sink)
        kind = sink.get("type")
        if not isinstance(kind, str) or kind not in MOVES:
            continue
        if isinstance(link := sink.get("link"), str) and link not in links:
            yield ("sinks", index, "link"), f"must be one of the links ({', '.join(links) or 'none'}), not {link!r}"
        rate = number(sink.get("rate"))
        if sink.get("mode") in ("speed", "stick") and rate is not None and rate < MIN_SPEED_RATE:
            yield ("sinks", index, "rate"), f"must be at least {MIN_SPEED_RATE}: a gimbal forgets a speed after 0.5 s"
        for axis, full in mapping(sink, "full_stick").items():
            velocity = number(mapping(axes, axis).get("velocity"))
            if velocity is not None and number(full) is not None and velocity > full:
                yield ("axes", axis, "velocity"), f"must be at most {full:g}, what full stick gives in sinks[{index}]"
        moves = [axis for axis in mapping(sink, "mapping").values() if isinstance(axis, str)] or MOVES[kind]
        moved = [axis for axis in moves if axis in axes]
        if moves and not moved:
            yield ("sinks", index), f"moves {', '.join(moves)}, and axes has none of them"
        for axis in moved:
            if axis in mover:
                yield ("sinks", index), f"moves {axis}, and so does sinks[{mover[axis]}]"
            mover[axis] = index
    for axis in axes:
        if axis in AXES and axis not in mover:
            yield ("axes", axis), "has no sink that moves it"


def _url_error(url: str) -> str:
    try:
        parse(url)
    except LinkUrlError as error:
        return str(error)
    return ""


def _with_links(profile: Profile, document: Document, links: Mapping[str, str]) -> Profile:
    problems = []
    for name, url in links.items():
        if name not in profile.links:
            problems.append(f"--link {name}: {document.name} has no such link; it has {', '.join(profile.links)}")
        elif wrong := _url_error(url):
            problems.append(f"--link {name}: {wrong}")
    if problems:
        raise DocumentError(problems)
    return profile.model_copy(update={"links": {**profile.links, **links}})
