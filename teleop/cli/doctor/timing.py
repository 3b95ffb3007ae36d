"""What `teleop doctor` says of time: whether real time may be asked for, and how late a loop wakes here."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from teleop.cli.doctor.finding import Finding, Findings, State
from teleop.core.clock import SystemClock
from teleop.core.timing import PERIOD, RATE

SECONDS = 2.0  # s of sleeping for the lateness
GOOD, USABLE = 0.002, PERIOD  # s of lateness at p99: a fifth of a tick, and a tick


def scheduling() -> Findings:
    """Whether this user may ask for real time, which halves the worst lateness on a busy machine, and the governor."""
    cores = os.cpu_count()
    if not hasattr(os, "sched_setscheduler"):
        yield Finding("scheduling", State.NOTE, f"{cores} cores, no SCHED_FIFO on this system")
        return
    before = os.sched_getscheduler(0), os.sched_getparam(0)
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
        os.sched_setscheduler(0, *before)
        yield Finding("scheduling", State.OK, f"{cores} cores, SCHED_FIFO permitted: chrt --fifo 50 teleop live")
    except PermissionError:
        todo = f"for quieter timing: echo '{_user()} - rtprio 50' | sudo tee /etc/security/limits.d/teleop.conf"
        yield Finding("scheduling", State.NOTE, f"{cores} cores, SCHED_FIFO not permitted", f"{todo}; log in again")
    if hasattr(os, "nice") and (nice := os.nice(0)) > 0:
        yield Finding(
            "scheduling", State.NOTE, f"nice {nice}: everything else here comes first", "start it without nice"
        )
    governors = {
        path.read_text().strip() for path in Path("/sys/devices/system/cpu").glob("cpu*/cpufreq/scaling_governor")
    }
    if governors & {"powersave", "ondemand", "conservative"}:
        todo = "echo performance | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor"
        yield Finding("scheduling", State.NOTE, f"CPU governor {', '.join(sorted(governors))}", todo)


def lateness(seconds: float = SECONDS) -> Findings:
    """How late a loop wakes that does nothing else: no program here can do better than that."""
    p50, p99, most = percentiles(sleep_late(round(seconds * RATE)))
    found = f"a bare {RATE} Hz loop wakes {p50:.2f} / {p99:.2f} / {most:.2f} ms late (p50 / p99 / max)"
    if p99 <= 1000 * GOOD:
        yield Finding("timing", State.OK, found)
    elif p99 <= 1000 * USABLE:
        yield Finding("timing", State.NOTE, f"{found}: usable", "close what else runs here")
    else:
        yield Finding(
            "timing", State.PROBLEM, f"{found}: more than a tick", "close what else runs here, or take another machine"
        )


def sleep_late(ticks: int) -> list[float]:
    """The lateness (s) of each of so many ticks."""
    clock = SystemClock()
    origin, late = clock.now(), []
    for tick in range(1, ticks + 1):
        due = origin + tick * PERIOD
        clock.sleep_until(due)
        late.append(clock.now() - due)
    return late


def percentiles(late: Sequence[float]) -> tuple[float, float, float]:
    """p50, p99 and the most, in ms."""
    ordered = sorted(late)
    return tuple(1000 * ordered[min(len(ordered) - 1, int(share * len(ordered)))] for share in (0.5, 0.99, 1.0))  # type: ignore[return-value]  # three of them


def _user() -> str:
    """Who this is to limits.conf, which takes `:1000` for a user that has no name, as in many a container."""
    import pwd

    try:
        return pwd.getpwuid(os.getuid()).pw_name
    except KeyError:
        return f":{os.getuid()}"
