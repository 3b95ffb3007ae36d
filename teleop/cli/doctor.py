"""`teleop doctor`: what this machine can do, what is in the way, and what to do about it.

A check is a function that looks at one thing and says a line or more; none of them can fail, because what cannot be
looked at is itself an answer. Only what makes every run impossible is a failure of the doctor: a machine without a pad
still plays sequences.
"""

from __future__ import annotations

import importlib
import json
import os
import platform
import shutil
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field
from enum import StrEnum
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from teleop.cli.devices import kernel_can, vendor_can
from teleop.cli.doctor_rules import HIDRAW, SERIAL, hid_rule, serial_rule
from teleop.clock import SystemClock
from teleop.loop import PERIOD, RATE

PYTHON = (3, 11)
PACKAGES = {  # by name, what is imported of it
    "rs-teleop": "teleop",
    "python-can": "can",
    "pyserial": "serial",
    "hidapi": "hidraw",
    "ruckig": "ruckig",
    "numpy": "numpy",
    "pydantic": "pydantic",
}
SPARE = {"hidapi"}  # without these some things work
SECONDS = 2.0  # s of sleeping for the lateness
GOOD, USABLE = 0.002, PERIOD  # s of lateness at p99: a fifth of a tick, and a tick
ROOM = 0.5e9  # bytes for takes: an hour and more
RULES = "/etc/udev/rules.d/70-teleop.rules"  # before 73, where systemd looks for uaccess


class State(StrEnum):
    OK = "ok"
    NOTE = "note"  # it works, and could work better
    PROBLEM = "problem"  # something does not work
    FATAL = "fatal"  # nothing does


@dataclass(frozen=True, slots=True)
class Finding:
    """What was looked at, what was found, and what to do about it; `rules` are lines for a udev file."""

    about: str
    state: State
    found: str
    todo: str = ""
    rules: Sequence[str] = field(default_factory=list)


Findings = Iterator[Finding]


def doctor(*, as_json: Annotated[bool, Parameter(name="--json", negative="")] = False) -> int:
    """Say what this machine can do: packages, permissions, adapters, timing, room for takes.

    Parameters
    ----------
    as_json
        One JSON object, for programs.
    """
    findings = [finding for check in CHECKS for finding in check()]
    if as_json:
        print(json.dumps({"ok": not _fatal(findings), "findings": [asdict(each) for each in findings]}))
    else:
        _print(findings)
    return 1 if _fatal(findings) else 0


def python() -> Findings:
    found = f"Python {platform.python_version()} on {platform.system()} {platform.release()}, {platform.machine()}"
    if sys.version_info >= PYTHON:
        yield Finding("python", State.OK, found)
    else:
        yield Finding("python", State.FATAL, found, "install Python 3.11 or later")


def packages() -> Findings:
    versions = []
    for package, module in PACKAGES.items():
        try:
            importlib.import_module(module)
            versions.append(f"{package} {version(package)}")
        except (
            ImportError,
            OSError,
            PackageNotFoundError,
        ) as error:  # OSError: a shared library of the system is missing
            state = State.PROBLEM if package in SPARE else State.FATAL
            yield Finding("packages", state, f"{package}: {error}", "pip install --force-reinstall rs-teleop")
    if versions:
        yield Finding("packages", State.OK, ", ".join(versions))


def hid() -> Findings:
    """Whether pads and dials may be opened: only hidraw sees those on Bluetooth, and udev decides who may use it."""
    if sys.platform != "linux":
        yield Finding("hid", State.NOTE, "hidraw is Linux's; here libusb or the system's own is asked")
        return
    devices = sorted(HIDRAW.glob("hidraw*"))
    shut = [device for device in devices if not os.access(Path("/dev") / device.name, os.R_OK | os.W_OK)]
    rules = list(dict.fromkeys(rule for device in shut if (rule := hid_rule(device))))
    if rules:
        names = ", ".join(f"/dev/{device.name}" for device in shut if hid_rule(device))
        yield Finding("hid", State.PROBLEM, f"no permission to open {names}", _write_rules(), rules)
    elif devices:
        yield Finding("hid", State.OK, f"{len(devices) - len(shut)} of {len(devices)} hidraw devices may be opened")
    else:
        yield Finding("hid", State.NOTE, "no hidraw device here", "plug a pad in and ask again, for the rule it needs")


def serial() -> Findings:
    ports = [Path("/dev") / tty.name for tty in sorted(SERIAL.glob("tty*")) if (tty / "device/driver").exists()]
    ports = [port for port in ports if port.name.startswith(("ttyACM", "ttyUSB"))]
    shut = [port for port in ports if not os.access(port, os.R_OK | os.W_OK)]
    if shut:
        names = ", ".join(map(str, shut))
        yield Finding("serial", State.PROBLEM, f"no permission to open {names}", _write_rules(), [serial_rule()])
    elif ports:
        yield Finding("serial", State.OK, ", ".join(map(str, ports)))
    else:
        yield Finding("serial", State.NOTE, "no USB serial port here")


def can_adapters() -> Findings:
    kernel, vendors = kernel_can(), vendor_can()
    for device in [*kernel.devices, *vendors.devices]:
        down = device.description.removeprefix("down: ")
        if down != device.description:
            yield Finding("can", State.PROBLEM, f"{device.names[0]} is down", down)
        else:
            yield Finding("can", State.OK, f"{device.names[0]} ({device.description})")
    for note in [*kernel.notes, *vendors.notes]:
        yield Finding("can", State.NOTE, note)
    if not kernel.devices and not vendors.devices:
        yield Finding("can", State.NOTE, "no CAN adapter found; an slcan one is among the serial ports")


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
    if (nice := os.nice(0)) > 0:
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


def disk() -> Findings:
    free = shutil.disk_usage(".").free
    found = f"{free / 1e9:.1f} GB free for takes in {Path.cwd()}"
    if free < ROOM:
        yield Finding("disk", State.PROBLEM, found, "make room, or give --take a path on another disk")
    elif not os.access(".", os.W_OK):
        yield Finding("disk", State.PROBLEM, f"no permission to write in {Path.cwd()}", "give --take another path")
    else:
        yield Finding("disk", State.OK, found)


def terminal() -> Findings:
    if not sys.stderr.isatty() or not sys.stdin.isatty():
        yield Finding("terminal", State.NOTE, "not a terminal: no live view and no keys here")
        return
    columns, rows = shutil.get_terminal_size()
    unicode = "UTF-8" in (sys.stderr.encoding or "").upper()
    found = f"{os.environ.get('TERM', 'unknown')}, {columns} x {rows}, {sys.stderr.encoding}"
    if unicode and columns >= 80:
        yield Finding("terminal", State.OK, found)
    else:
        yield Finding("terminal", State.NOTE, found, "80 columns and UTF-8 show the live view best")


CHECKS: Sequence[Callable[[], Findings]] = (
    python, packages, hid, serial, can_adapters, scheduling, lateness, disk, terminal
)  # fmt: skip


def _fatal(findings: Sequence[Finding]) -> bool:
    return any(finding.state is State.FATAL for finding in findings)


def _user() -> str:
    import getpass

    return getpass.getuser()


def _write_rules() -> str:
    return f"write these lines into {RULES}, then: sudo udevadm control --reload && sudo udevadm trigger"


def _print(findings: Sequence[Finding]) -> None:
    """A line for each finding, what to do beneath it, and udev's lines by themselves, ready to be copied."""
    marks = {State.OK: "ok", State.NOTE: "--", State.PROBLEM: "!!", State.FATAL: "XX"}
    for each in findings:
        print(f"{marks[each.state]}  {each.about:<10} {each.found}" + (f": {each.todo}" if each.todo else ""))
        for rule in each.rules:
            print(rule)
    worst = [each for each in findings if each.state in (State.PROBLEM, State.FATAL)]
    print(f"{len(worst)} {'thing is' if len(worst) == 1 else 'things are'} in the way" if worst else "ready")
