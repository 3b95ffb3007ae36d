"""What `teleop doctor` looks at in the computer: Python and the packages, room for takes, the terminal."""

from __future__ import annotations

import importlib
import os
import platform
import shutil
import sys
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from teleop.cli.doctor.finding import Finding, Findings, State

PYTHON = (3, 11)
PACKAGES = {  # by name, what is imported of it
    "rs-teleop": "teleop",
    "python-can": "can",
    "pyserial": "serial",
    "hidapi": "hidraw",
    **({"evdev": "evdev"} if sys.platform == "linux" else {}),
    "ruckig": "ruckig",
    "numpy": "numpy",
    "pydantic": "pydantic",
}
SPARE = {"hidapi", "evdev"}  # without these some things work
ROOM = 0.5e9  # bytes for takes: an hour and more


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


def disk() -> Findings:
    try:
        here = Path.cwd()
        free = shutil.disk_usage(here).free
    except OSError as error:  # a directory that was deleted under the shell
        yield Finding("disk", State.PROBLEM, f"this directory cannot be used: {error.strerror}", "change to another")
        return
    found = f"{free / 1e9:.1f} GB free for takes in {here}"
    if free < ROOM:
        yield Finding("disk", State.PROBLEM, found, "make room, or give --take a path on another disk")
    elif not os.access(here, os.W_OK):
        yield Finding("disk", State.PROBLEM, f"no permission to write in {here}", "give --take another path")
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
