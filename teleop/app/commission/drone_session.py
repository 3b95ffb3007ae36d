"""A commissioning of a rig's drone: opened, run by whoever has a clock and keys, and what it found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Self

from teleop.app.commission.session import begun
from teleop.commission.drone.bench import DroneBench
from teleop.commission.drone.link import DroneLink
from teleop.commission.drone.steps import drone_steps
from teleop.commission.findings import Findings
from teleop.commission.runner import Runner
from teleop.config.credentials import load_credentials
from teleop.config.profile import Profile
from teleop.core.interfaces import Clock, Link
from teleop.devices.drone.last_enable import LastEnable, default_file
from teleop.dji.drone.messages import Activate
from teleop.links.url import LinkAddress
from teleop.sim.drone.device import SimulatedDrone

MODEL = "Matrice 100"  # the only one with virtual RC: docs/protocol-facts.md


@dataclass
class DroneCommissioning:
    """As `Commissioning`; it writes no profile: a drone's section has nothing that is measured.

    Raises UsageError for a rig without a drone, DocumentError without an app id, LinkError when its link cannot be
    opened.
    """

    profile: Profile
    clock: Clock
    simulated: SimulatedDrone | None = None
    tapped: Callable[[LinkAddress], Callable[[Link], Link]] | None = None

    def __post_init__(self) -> None:
        self.link = DroneLink(self.profile, self.clock, self.simulated)
        is_simulated = self.link.simulated is not None
        activation = Activate(0) if is_simulated else load_credentials().activation()
        last = None if is_simulated else LastEnable(default_file())
        if self.tapped:
            self.link.tap = self.tapped(self.link.address)
        self.bench = DroneBench(self.link.open, activation, self.link.cipher, last)
        self.runner = Runner(self.bench, drone_steps(self.bench), begun(self.profile, "drone", self.link.address))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if not self.runner.over:
            self.bench.release_at_once()
        self.link.close()

    @property
    def findings(self) -> Findings:
        """All that was found, with the firmware's name for itself."""
        found, serial = self.runner.findings, self.bench.serial
        serials = {**found.serials, **({"drone": serial} if serial else {})}
        return replace(found, model=MODEL, firmware=self.bench.firmware, serials=serials)
