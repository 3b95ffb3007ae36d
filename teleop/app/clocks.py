"""The clock of a run: the machine's, or a virtual one on which nothing waits."""

from __future__ import annotations

from teleop.config.profile import Profile
from teleop.core.clock import SystemClock, VirtualClock
from teleop.links import parse


def clock_for(virtual: bool) -> SystemClock | VirtualClock:
    return VirtualClock() if virtual else SystemClock()


def real_links(profile: Profile) -> list[str]:
    """The links, as NAME=URL, that end at real devices: these run in real time."""
    return [f"{name}={url}" for name, url in profile.links.items() if parse(url).kind != "sim"]
