"""`teleop sim`: the simulated gimbal alone, at the far end of a real bus."""

from __future__ import annotations

import sys
import threading
from collections.abc import Mapping

from teleop.cli.options import DEFAULTS, Options
from teleop.cli.perform import signals_to
from teleop.clock import SystemClock
from teleop.document import DocumentError
from teleop.links import ClosableLink, open_link, parse
from teleop.sim.gimbal import SimulatedGimbal

PERIOD = 0.002  # s between looks at the bus: a real gimbal answers within 5 ms
STATUS = 1.0  # s between status lines


def sim(*, options: Options = DEFAULTS) -> int:
    """Simulate the devices of a rig on real links, so that another process drives them: --link gimbal=URL."""
    profile = options.profile()
    urls = {name: url for name, url in profile.links.items() if parse(url).kind != "sim"}
    if not urls:
        raise DocumentError(["teleop sim needs a bus to be on: --link gimbal=udp_multicast:239.74.163.2"])
    clock = SystemClock()
    stop = threading.Event()
    links: dict[str, ClosableLink] = {}
    try:
        for name, url in urls.items():
            links[name] = open_link(url, host=False, now=clock.now)
            print(f"simulated {name} on {url}", flush=True)
        with signals_to(lambda _reason: stop.set()):
            serve(links, {name: SimulatedGimbal() for name in links}, clock, stop)
    finally:
        for link in links.values():
            link.close()
    return 130


def serve(
    links: Mapping[str, ClosableLink],
    gimbals: Mapping[str, SimulatedGimbal],
    clock: SystemClock,
    stop: threading.Event,
) -> None:
    """Pass bytes between links and gimbals until told to stop; raises LinkError when a link is lost."""
    due = clock.now()
    said = -STATUS
    while not stop.is_set():
        now = clock.now()
        for name, link in links.items():
            gimbals[name].receive(link.receive(), now)
            if answer := gimbals[name].advance(now):
                link.send(answer)
        if sys.stderr.isatty() and now - said >= STATUS:
            said = now
            print(*(status(name, gimbal) for name, gimbal in gimbals.items()), sep="   ", file=sys.stderr)
        due = max(due + PERIOD, now)
        clock.sleep_until(due)


def status(name: str, gimbal: SimulatedGimbal) -> str:
    """Where a simulated gimbal is and what it is doing, in a line."""
    yaw, roll, pitch = gimbal.angles
    taken = ", speed control taken over" if gimbal.controlled else ""
    recording = ", recording" if gimbal.recording else ""
    return f"{name}: yaw {yaw:+.1f} roll {roll:+.1f} pitch {pitch:+.1f} deg{taken}{recording}"
