"""The gimbals of several hosts, each on a bus of its own, in one process: `python fleet_gimbals.py NAMESPACE...`.

It says `ready` once they answer. When its input ends, it prints the pans that each was commanded to and when, by one
clock: a JSON list for each host of pairs of s (monotonic) and deg. In real time, where that is permitted: a gimbal that
a busy computer keeps from answering is given up by its rig.
"""

from __future__ import annotations

import json
import os
import sys
import threading
from contextlib import ExitStack, suppress

from far_gimbal import FarGimbal
from fleet_net import Host

from teleop.cli.sim import serve
from teleop.core.clock import SystemClock
from teleop.dji.gimbal import messages as gimbal
from teleop.links import open_link

BUS = "udp_multicast:239.74.163.2"


def main(*namespaces: str) -> None:
    stop, clock = threading.Event(), SystemClock()
    with ExitStack() as stack:
        links, devices = {}, {}
        for namespace in namespaces:
            with Host.inside_of(namespace):
                links[namespace] = open_link(BUS, host=False, now=clock.now)
            stack.callback(links[namespace].close)
            devices[namespace] = FarGimbal()

        def listen() -> None:
            sys.stdin.read()
            stop.set()

        threading.Thread(target=listen, daemon=True).start()
        with suppress(OSError, AttributeError):
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(20))
        sys.stdout.write("ready\n")
        sys.stdout.flush()
        serve(links, devices, clock, stop)
        for device in devices.values():
            pans = [(time, message.yaw) for time, message in device.heard_of(gimbal.Position)]
            sys.stdout.write(json.dumps(pans) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
