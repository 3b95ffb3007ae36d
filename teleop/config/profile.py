"""A rig described in YAML, checked whole before any port opens.

pydantic checks each value; the rules of this module check what lies between values (a sink's link exists, every axis
is moved by exactly one sink). The rules read the plain data, not the checked model, so that they still speak when
some value is wrong and a file's errors come all at once. Angles are degrees, focus is 0..1; magnitudes are per
second, per second squared and per second cubed.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import Annotated, Any

from pydantic import AfterValidator, Field

from teleop.config.device_commands import DRONE
from teleop.config.documents.base_model import Finite, Section
from teleop.config.documents.document import Document, DocumentError, Wrong, mapping, number
from teleop.config.documents.yaml_loader import parse_document, read_document
from teleop.config.enable_rules import enable_rules
from teleop.config.exchange import ExchangeSection, exchange_rules
from teleop.config.file_kinds import refuse_other_kind
from teleop.config.inputs_section import InputSection, input_rules
from teleop.config.operator_settings import PresetsSection, SticksSection
from teleop.config.resources import find
from teleop.config.sink_rules import sink_rules
from teleop.config.sinks_section import (
    DRONES,
    MOVES,
    FlightSection,
    GimbalSection,
    Magnitude,
    SinkSection,
    VirtualRcSection,
)
from teleop.core.axes import Axis, Limits
from teleop.core.events import Action, DeviceCommand, Exposure
from teleop.core.plain import plain
from teleop.links.url import LinkUrlError, parse

AxisName = Annotated[Axis, Field(strict=False)]


class AxisSection(Section):
    """One axis: its soft limits and its maximum velocity, acceleration and jerk."""

    min: Finite | None
    """Lower soft limit in deg (focus and sticks: no unit); null for an axis that turns without end."""
    max: Finite | None
    """Upper soft limit in deg (focus and sticks: no unit); null for an axis that turns without end."""
    velocity: Magnitude
    """Maximum velocity in deg/s (focus and sticks: per s)."""
    acceleration: Magnitude
    """Maximum acceleration in deg/s2 (focus and sticks: per s2)."""
    jerk: Magnitude
    """Maximum jerk in deg/s3 (focus and sticks: per s3)."""

    def limits(self) -> Limits:
        low = -math.inf if self.min is None else self.min
        high = math.inf if self.max is None else self.max
        return Limits(low, high, self.velocity, self.acceleration, self.jerk)


class ShootingSection(Section):
    """How a timelapse is shot on this rig."""

    wait_for_link: bool = False
    """Wait for a lost link and continue, instead of ending the shoot."""


class Profile(Section):
    """A rig: links, axes, and the sinks that drive them in their order."""

    name: Annotated[str, Field(min_length=1), AfterValidator(plain)]
    """Name of the rig on screens and in errors."""
    links: dict[str, str]
    """URL of each link by its name: `socketcan:can0`, `serial:/dev/ttyUSB0@230400`, `sim:`."""
    axes: Annotated[dict[AxisName, AxisSection], Field(min_length=1)]
    """The axes of the rig, each with its soft limits and maximum velocity, acceleration and jerk."""
    sinks: list[Annotated[SinkSection, Field(discriminator="type")]]
    """The devices that move the axes or obey cues, each on one of the links."""
    sticks: SticksSection = SticksSection()
    """How stick deflection becomes velocity."""
    presets: PresetsSection = PresetsSection()
    """Settings of presets: how long a recall takes."""
    inputs: list[InputSection] = Field(default_factory=list)
    """Joysticks, pads and dials, and what each of their controls does."""
    timelapse: ShootingSection = ShootingSection()
    """Settings of every timelapse on this rig."""
    exchange: list[ExchangeSection] = Field(default_factory=list)
    """What is spoken with other programs and devices while the rig runs, each entry one format."""

    @property
    def drones(self) -> frozenset[str]:
        """The names of the links that end at a drone."""
        return frozenset(section.link for section in self.sinks if section.type in DRONES)

    @property
    def optional(self) -> frozenset[str]:
        """The names of the links without a gimbal: a live run goes on without what is at their ends."""
        return frozenset(self.links) - {section.link for section in self.sinks if section.type == "gimbal"}

    def in_use(self, axes: Collection[Axis], acts: Iterable[object] = ()) -> Profile:
        """The rig with only the links that a run over `axes` needs, one that also performs the `acts`."""
        acts = list(acts)
        needed = {section.link for section in self.sinks if _is_used(section, axes, acts)}
        return self.with_links(needed)

    def with_links(self, names: Collection[str]) -> Profile:
        """The rig with only these links, and what is at their ends."""
        links = {name: url for name, url in self.links.items() if name in names}
        sinks = [section for section in self.sinks if section.link in links]
        return self.model_copy(update={"links": links, "sinks": sinks})

    def gentler(self, share: float) -> Profile:
        """The rig with so much of the velocity, acceleration and jerk of each axis."""
        if share == 1:
            return self
        changes = {axis: section.limits().scaled(share) for axis, section in self.axes.items()}
        axes = {
            axis: section.model_copy(
                update={name: getattr(changes[axis], name) for name in ("velocity", "acceleration", "jerk")}
            )
            for axis, section in self.axes.items()
        }
        return self.model_copy(update={"axes": axes})

    @property
    def encrypted(self) -> frozenset[str]:
        """Those of them over which the app's key encrypts."""
        drones = (section for section in self.sinks if isinstance(section, VirtualRcSection | FlightSection))
        return frozenset(section.link for section in drones if section.encrypted)

    @property
    def limits(self) -> Mapping[Axis, Limits]:
        return {axis: section.limits() for axis, section in self.axes.items()}


def _is_used(section: SinkSection, axes: Collection[Axis], acts: Iterable[object]) -> bool:
    moves = section.axes if isinstance(section, GimbalSection) else MOVES[section.type]
    if any(axis in axes for axis in moves if axis is not None):
        return True
    addressees = {act.device for act in acts if isinstance(act, DeviceCommand)}
    match section.type:
        case "camera":
            return any(isinstance(act, Action | Exposure) for act in acts)
        case "gimbal":
            return bool(addressees - {DRONE})
        case "virtual-rc" | "flight":
            return DRONE in addressees
    return False


def load_profile(name: str, links: Mapping[str, str] | None = None, option: str = "link ") -> Profile:
    """The profile called `name`, shipped or at a path, with the URLs of some of its `links` replaced.

    Raises DocumentError with a line for each mistake; one about a replaced link begins with `option`.
    """
    document = read_document(*find(name, "profiles", "rig"))
    return _with_links(_checked(document), document, links or {}, option)


def checked_profile(text: str, name: str) -> Profile:
    """The profile that `text` would be in a file, called `name` in errors; raises DocumentError."""
    return _checked(parse_document(text.removeprefix("\ufeff"), name))


def _checked(document: Document) -> Profile:
    refuse_other_kind(document, "profile")
    return document.check(Profile, _rules(document.data))


def _rules(data: Any) -> Iterator[Wrong]:
    for name, section in mapping(data, "axes").items():
        yield from _axis_rules(name, section)
    for name, url in mapping(data, "links").items():
        if isinstance(url, str) and (wrong := _url_error(url)):
            yield ("links", name), wrong
    yield from sink_rules(data)
    yield from input_rules(data)
    yield from enable_rules(data)
    yield from exchange_rules(data)


def _axis_rules(name: str, section: Any) -> Iterator[Wrong]:
    section = mapping(section)
    low, high = section.get("min"), section.get("max")
    if "min" in section and "max" in section and (low is None) != (high is None):
        yield ("axes", name, "min"), "and max must both be numbers, or both null for a continuous axis"
    if number(low) is not None and number(high) is not None and low >= high:
        yield ("axes", name, "min"), f"must be less than max ({high:g})"


def _url_error(url: str) -> str:
    try:
        parse(url)
    except LinkUrlError as error:
        return str(error)
    return ""


def _with_links(profile: Profile, document: Document, links: Mapping[str, str], option: str) -> Profile:
    problems = []
    for name, url in links.items():
        if name not in profile.links:
            problems.append(f"{option}{name}: {document.name} has no such link; it has {', '.join(profile.links)}")
        elif wrong := _url_error(url):
            problems.append(f"{option}{name}: {wrong}")
    if problems:
        raise DocumentError(problems)
    return profile.model_copy(update={"links": {**profile.links, **links}})
