"""`teleop sim`: simulated devices alone, at the far end of a real bus or, a drone, of a serial line of its own."""

from __future__ import annotations

import sys
import threading
from collections.abc import Mapping
from typing import Annotated

from cyclopts import Parameter

from teleop.cli.leaving import signals_to
from teleop.cli.options import DEFAULTS, Options
from teleop.clock import SystemClock
from teleop.document import DocumentError
from teleop.links import ClosableLink, open_link, parse
from teleop.sim.drone import SimulatedDrone
from teleop.sim.gimbal import SimulatedGimbal

PERIOD = 0.002  # s between looks at the bus: a real gimbal answers within 5 ms
STATUS = 1.0  # s between status lines


BAUD = 230400  # of the Matrice 100: docs/protocol-facts.md; a pseudo-terminal does not mind

SimulatedDevice = SimulatedGimbal | SimulatedDrone


def sim(
    *,
    drone: Annotated[
        bool, Parameter(help="Simulate a drone too, on a serial port that is made for it.", negative=())
    ] = False,
    options: Options = DEFAULTS,
) -> int:
    """Simulate the devices of a rig on real links, so that another process drives them: --link gimbal=URL."""
    profile = options.profile()
    urls = {name: url for name, url in profile.links.items() if parse(url).kind != "sim"}
    if not urls and not drone:
        raise DocumentError(
            ["teleop sim needs a bus to be on: --link gimbal=udp_multicast:239.74.163.2, or --drone for a drone"]
        )
    clock = SystemClock()
    stop = threading.Event()
    links: dict[str, ClosableLink] = {}
    devices: dict[str, SimulatedDevice] = {}
    try:
        for name, url in urls.items():
            links[name] = open_link(url, host=False, now=clock.now)
            devices[name] = SimulatedDrone(now=clock.now()) if name in profile.drones else SimulatedGimbal()
            print(f"simulated {name} on {url}", flush=True)
        if drone:
            from teleop.links.pty import PtyLink

            links["drone"] = line = PtyLink()
            devices["drone"] = SimulatedDrone(now=clock.now())
            print(f"simulated drone on serial:{line.path}@{BAUD}", flush=True)
        with signals_to(lambda _reason: stop.set()):
            serve(links, devices, clock, stop)
    finally:
        for link in links.values():
            link.close()
    return 130


def serve(
    links: Mapping[str, ClosableLink],
    devices: Mapping[str, SimulatedDevice],
    clock: SystemClock,
    stop: threading.Event,
) -> None:
    """Pass bytes between links and devices until told to stop; raises LinkError when a link is lost."""
    due = clock.now()
    said = -STATUS
    while not stop.is_set():
        now = clock.now()
        for name, link in links.items():
            devices[name].receive(link.receive(), now)
            if answer := devices[name].advance(now):
                link.send(answer)
        if sys.stderr.isatty() and now - said >= STATUS:
            said = now
            print(*(status(name, device) for name, device in devices.items()), sep="   ", file=sys.stderr)
        due = max(due + PERIOD, now)
        clock.sleep_until(due)


def status(name: str, device: SimulatedDevice) -> str:
    """Where a simulated device is and what it is doing, in a line."""
    if isinstance(device, SimulatedDrone):
        cockpit, pose = device.cockpit, device.cockpit.pose
        state = "CRASHED" if cockpit.flight.crashed else "LOCKED" if cockpit.locked else cockpit.status.name.lower()
        where = f"{pose.north:+.1f} {pose.east:+.1f} m, {pose.height:.1f} m high"
        return f"{name}: {state}, {where}, flown by {cockpit.pilot.value}, battery {cockpit.battery:.0f} %"
    yaw, roll, pitch = device.angles
    taken = ", speed control taken over" if device.controlled else ""
    recording = ", recording" if device.recording else ""
    return f"{name}: yaw {yaw:+.1f} roll {roll:+.1f} pitch {pitch:+.1f} deg{taken}{recording}"
