"""What is said of pads, serial ports and CAN adapters that are here, and that may not be opened."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from teleop.cli.doctor import devices
from teleop.cli.doctor.finding import State

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="hidraw and /sys are Linux's")


def tty(folder: Path, *names: str) -> None:
    for name in names:
        (folder / name / "device" / "driver").mkdir(parents=True)


def closed(monkeypatch: pytest.MonkeyPatch, *paths: str) -> None:
    monkeypatch.setattr(os, "access", lambda path, _mode: str(path) not in paths)


def adapters(monkeypatch: pytest.MonkeyPatch, *found: tuple[str, str], notes: tuple[str, ...] = ()) -> None:
    listed = [SimpleNamespace(names=[name], description=description) for name, description in found]
    monkeypatch.setattr(devices, "kernel_can", lambda: SimpleNamespace(devices=listed, notes=notes))
    monkeypatch.setattr(devices, "vendor_can", lambda: SimpleNamespace(devices=[], notes=[]))


def test_a_serial_port_that_may_not_be_opened_gets_a_rule(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    tty(tmp_path, "ttyUSB0", "ttyACM0", "ttyS0")
    monkeypatch.setattr(devices, "SERIAL", tmp_path)
    closed(monkeypatch, "/dev/ttyUSB0", "/dev/ttyS0")
    (finding,) = devices.serial()
    assert (finding.state, finding.found) == (State.PROBLEM, "no permission to open /dev/ttyUSB0")
    assert devices.RULES in finding.todo
    assert finding.rules


def test_serial_ports_that_may_be_opened_are_listed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(devices, "SERIAL", tmp_path)
    (finding,) = devices.serial()
    assert finding.state is State.NOTE
    tty(tmp_path, "ttyUSB0", "ttyACM0")
    closed(monkeypatch)
    (finding,) = devices.serial()
    assert (finding.state, finding.found) == (State.OK, "/dev/ttyACM0, /dev/ttyUSB0")


def test_a_can_interface_that_is_down_is_a_problem_with_its_command(monkeypatch: pytest.MonkeyPatch):
    adapters(monkeypatch, ("socketcan:can0", "down: sudo ip link set can0 up"), ("socketcan:can1", "up"))
    down, up = devices.can_adapters()
    assert (down.state, down.found, down.todo) == (
        State.PROBLEM,
        "socketcan:can0 is down",
        "sudo ip link set can0 up",
    )
    assert (up.state, up.found) == (State.OK, "socketcan:can1 (up)")


def test_without_an_adapter_that_is_said_after_what_could_not_be_looked_at(monkeypatch: pytest.MonkeyPatch):
    adapters(monkeypatch, notes=("pcan: no driver",))
    assert [each.found.partition(";")[0] for each in devices.can_adapters()] == [
        "pcan: no driver",
        "no CAN adapter found",
    ]


def test_hidraw_devices_that_need_no_rule_are_no_problem(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(devices, "HIDRAW", tmp_path)
    monkeypatch.setattr(devices, "hid_rule", lambda device: "a rule" if device.name == "hidraw1" else "")
    (nothing,) = devices.hid()
    assert nothing.state is State.NOTE
    for name in ("hidraw0", "hidraw1"):
        (tmp_path / name).mkdir()
    closed(monkeypatch, "/dev/hidraw0")
    (finding,) = devices.hid()
    assert (finding.state, finding.found) == (State.OK, "1 of 2 hidraw devices may be opened")
    closed(monkeypatch, "/dev/hidraw0", "/dev/hidraw1")
    (finding,) = devices.hid()
    assert (finding.state, finding.rules) == (State.PROBLEM, ["a rule"])
    assert "/dev/hidraw1" in finding.found
    assert "/dev/hidraw0" not in finding.found
