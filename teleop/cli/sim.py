"""`teleop sim`: simulated devices alone, at the far end of a real bus or, a drone, of a serial line of its own."""

from __future__ import annotations

import json
import random
import sys
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from teleop.cli.options import DEFAULTS, Options
from teleop.cli.screens.refusal_lines import RefusalLines
from teleop.cli.signals import signals_to
from teleop.cli.sim_dynamics import DYNAMICS_DEFAULTS, DynamicsSim
from teleop.cli.sim_options import DRONE_DEFAULTS, GIMBAL, GIMBAL_DEFAULTS, DroneSim, GimbalSim
from teleop.cli.sim_replay import facts, replayed, summary
from teleop.config.documents.document import DocumentError
from teleop.core.clock import SystemClock
from teleop.core.errors import DeviceError
from teleop.devices.gimbal.profile_simulation import simulated_firmware, simulated_settings
from teleop.links import ClosableLink, open_link, parse
from teleop.links.can import CanLink
from teleop.sim.drone.device import SimulatedDrone
from teleop.sim.gimbal.device import SimulatedGimbal
from teleop.sim.gimbal.foreign_traffic import ForeignTraffic
from teleop.sim.gimbal.replayed import ReplayedGimbal

POLL_PERIOD = 0.002  # s between looks at the bus: a real gimbal answers within 5 ms
STATUS = 1.0  # s between status lines
BAUD = 230400  # of the Matrice 100: docs/protocol-facts.md; a pseudo-terminal does not mind

SimulatedDevice = SimulatedGimbal | SimulatedDrone | ReplayedGimbal


def sim(
    *,
    drone: DroneSim = DRONE_DEFAULTS,
    gimbal: GimbalSim = GIMBAL_DEFAULTS,
    dynamics: DynamicsSim = DYNAMICS_DEFAULTS,
    replay: Annotated[
        Path | None,
        Parameter(
            metavar="CAPTURE",
            group=GIMBAL,
            help="Answer as the gimbal of this capture did (candump or MCAP); it cannot move.",
            show_default=False,
        ),
    ] = None,
    options: Options = DEFAULTS,
) -> int:
    """Simulate the devices of a rig on real links, so that another process drives them: --link gimbal=URL.

    What a device refuses is printed with the reason: each kind at once, then how often, and at the end all of it.
    """
    profile = options.profile()
    captured = None if replay is None else replayed(replay, gimbal, dynamics)
    urls = {name: url for name, url in profile.links.items() if parse(url).kind != "sim"}
    if not urls and not drone.drone:
        raise DocumentError(
            ["teleop sim needs a bus to be on: --link gimbal=udp_multicast:239.74.163.2, or --drone for a drone"]
        )
    clock = SystemClock()
    stop = threading.Event()
    links: dict[str, ClosableLink] = {}
    devices: dict[str, SimulatedDevice] = {}
    refusals = RefusalLines(_write, options.json)
    try:
        for name, url in urls.items():
            if name in profile.drones:
                devices[name] = drone.made(clock.now())
            elif captured:
                devices[name] = ReplayedGimbal(captured)
            else:
                settings = dynamics.settings(simulated_settings(profile, name))
                devices[name] = gimbal.made(settings, simulated_firmware(profile, name))
            links[name] = open_link(url, host=False, now=clock.now)
            _ready(name, url, options.json)
        if drone.drone:
            from teleop.links.pty import PtyLink

            devices["drone"] = drone.made(clock.now())
            try:
                links["drone"] = line = PtyLink()
            except OSError as error:
                text = f"the simulated drone cannot have a serial line here: {error}: a profile with sim: needs none"
                raise DeviceError(text) from None
            _ready("drone", f"serial:{line.path}@{BAUD}", options.json)
        if captured and replay:
            _write(json.dumps(facts(replay, captured)) if options.json else summary(replay, captured))
        with signals_to(lambda _reason: stop.set()):
            serve(links, devices, clock, stop, refusals, gimbal.foreign_traffic, gimbal.bus_errors)
    finally:
        for link in links.values():
            link.close()
        for name, device in devices.items():
            refusals.summary(name, device)
    return 130


def _write(line: str) -> None:
    print(line, flush=True)


def _ready(name: str, url: str, as_json: bool) -> None:
    line = f"simulated {name} on {url}"
    _write(json.dumps({"ready": line, "device": name, "link": url}) if as_json else line)


def serve(
    links: Mapping[str, ClosableLink],
    devices: Mapping[str, SimulatedDevice],
    clock: SystemClock,
    stop: threading.Event,
    refusals: RefusalLines | None = None,
    foreign_traffic: bool = False,
    bus_errors: float = 0.0,
) -> None:
    """Pass bytes between links and devices until stopped; raises LinkError when a link is lost."""
    due = clock.now()
    printed = -STATUS
    strangers = _strangers(links, due) if foreign_traffic else []
    noises = {name: BusNoise(link, bus_errors) for name, link in links.items()}
    while not stop.is_set():
        now = clock.now()
        for name, link in links.items():
            devices[name].receive(noises[name].left(link.receive()), now)
            if answer := noises[name].left(devices[name].advance(now)):
                link.send(answer)
            if refusals:
                refusals.look(name, devices[name], now)
        for send in strangers:
            send(now)
        if sys.stderr.isatty() and now - printed >= STATUS:
            printed = now
            print(*(status(name, device) for name, device in devices.items()), sep="   ", file=sys.stderr)
        due = max(due + POLL_PERIOD, now)
        clock.sleep_until(due)


class BusNoise:
    """A bus without termination: a share of what passes ends as error frames."""

    def __init__(self, link: ClosableLink, share: float) -> None:
        self._link, self._share, self._chance = link, share, random.Random(1)

    def left(self, data: bytes) -> bytes:
        """What is left of it: all, or nothing."""
        if not data or self._chance.random() >= self._share:
            return data
        if isinstance(self._link, CanLink):
            self._link.send_error()
        return b""


def _strangers(links: Mapping[str, ClosableLink], now: float) -> list[Callable[[float], None]]:
    """What sends a gimbal's own traffic on each CAN bus."""

    def sender(link: CanLink, traffic: ForeignTraffic) -> Callable[[float], None]:
        def send(time: float) -> None:
            for can_id, data in traffic.due(time):
                link.send_foreign(can_id, data)

        return send

    return [sender(link, ForeignTraffic(now)) for link in links.values() if isinstance(link, CanLink)]


def status(name: str, device: SimulatedDevice) -> str:
    """Where a simulated device is and what it is doing, in a line."""
    if isinstance(device, SimulatedDrone):
        autopilot, pose = device.autopilot, device.autopilot.pose
        state = (
            "CRASHED" if autopilot.flight.crashed else "LOCKED" if autopilot.locked else autopilot.status.name.lower()
        )
        where = f"{pose.north:+.1f} {pose.east:+.1f} m, {pose.height:.1f} m high"
        refused = f", {device.refusals.total} refused" if device.refusals.total else ""
        return f"{name}: {state}, {where}, flown by {autopilot.pilot.value}, battery {autopilot.battery:.0f} %{refused}"
    if isinstance(device, ReplayedGimbal):
        return f"{name}: replayed, {device.counts.total()} messages, {device.refusals.total} not in the capture"
    yaw, roll, pitch = device.angles
    taken = ", speed control taken over" if device.controlled else ""
    recording = ", recording" if device.recording else ""
    refused = f", {device.refusals.total} refused" if device.refusals.total else ""
    return f"{name}: yaw {yaw:+.1f} roll {roll:+.1f} pitch {pitch:+.1f} deg{taken}{recording}{refused}"
