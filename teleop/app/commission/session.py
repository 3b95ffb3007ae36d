"""A commissioning of a rig's gimbal: opened, run by whoever has a clock and keys, and its results."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import datetime
from importlib.metadata import version
from typing import Self

from teleop.app.commission.pad import PadStep
from teleop.app.commission.profile_file import ProfileFile
from teleop.app.commission.profile_step import ProfileStep
from teleop.commission.findings import Findings
from teleop.commission.gimbal.bench import GimbalBench
from teleop.commission.gimbal.link import GimbalLink
from teleop.commission.gimbal.steps import gimbal_steps
from teleop.commission.runner import Runner
from teleop.config.profile import Profile
from teleop.core.clock import date
from teleop.core.interfaces import Clock, Link
from teleop.inputs.hid.backend import HidBackend
from teleop.links.url import LinkAddress
from teleop.sim.gimbal.device import SimulatedGimbal

TICK = 0.01  # s between two turns
_BY_ID = "/by-id/"  # a path of Linux that has a serial number in it


@dataclass
class Commissioning:
    """Open from `start` on, or while it is entered; `turn` it every TICK s. `polled`: devices are read in `turn`.

    `tapped` is called with the link's address, and gives what taps the link. Raises UsageError for a rig without a
    gimbal, LinkError when its link cannot be opened.
    """

    profile: Profile
    file: ProfileFile
    clock: Clock
    backend: Callable[[], HidBackend]
    polled: bool = False
    simulated: SimulatedGimbal | None = None
    tapped: Callable[[LinkAddress], Callable[[Link], Link]] | None = None

    def __post_init__(self) -> None:
        self.link = GimbalLink(self.profile, self.clock, self.simulated)
        if self.tapped:
            self.link.tap = self.tapped(self.link.address)
        self.bench = GimbalBench(self.link.open, self.link.section)
        pad = PadStep(self.profile, self.backend, self.clock.now, self.polled)
        self._write = ProfileStep(self.file)
        steps = gimbal_steps(self.bench, self.link.address, [pad])
        self.runner = Runner(self.bench, steps, self._begun(), final=[self._write])

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if not self.runner.over:
            self.bench.release_at_once()
        self.link.close()

    @property
    def written(self) -> bool:
        """Whether the profile was written."""
        return self._write.written

    @property
    def findings(self) -> Findings:
        """All that was found, with the version and the model of the gimbal."""
        found = self.runner.findings
        model, firmware = (str(found.value(key) or "") for key in ("gimbal.model", "gimbal.version"))
        return replace(found, model=model, firmware=firmware)

    def _begun(self) -> Findings:
        return begun(self.profile, "gimbal", self.link.address)


def begun(profile: Profile, device: str, address: LinkAddress) -> Findings:
    """The findings before anything is found."""
    adapter, serials = without_serial(address)
    day = datetime.fromtimestamp(date()).strftime("%Y-%m-%d")
    return Findings(profile.name, device, adapter=adapter, program=version("rs-teleop"), date=day, serials=serials)


def without_serial(address: LinkAddress) -> tuple[str, dict[str, str]]:
    """The adapter as a report names it, and what that leaves out."""
    text = str(address)
    place, by_id, _ = text.partition(_BY_ID)
    return (f"{place}{by_id}...", {"adapter": text}) if by_id else (text, {})
