"""`teleop doctor`: what it says of a machine, above all the lines that are to be pasted."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Sequence
from pathlib import Path

import pytest
from command import teleop

from teleop.cli import devices, run
from teleop.cli.doctor import command as doctor
from teleop.cli.doctor import devices as doctor_devices
from teleop.cli.doctor import machine as doctor_machine
from teleop.cli.doctor import timing as doctor_timing
from teleop.cli.doctor.finding import Finding, State

PAD = "DRIVER=xpadneo\nHID_ID=0005:0000045E:00000B13\nHID_NAME=Xbox Wireless Controller\n"
PAD_DESCRIPTOR = b"\x05\x01\x09\x05\xa1\x01"
KEYBOARD_DESCRIPTOR = b"\x05\x01\x09\x06\xa1\x01"


def plugged(folder: Path, name: str, uevent: str, descriptor: bytes) -> None:
    device = folder / name / "device"
    device.mkdir(parents=True)
    (device / "uevent").write_text(uevent)
    (device / "report_descriptor").write_bytes(descriptor)


def forbid(monkeypatch: pytest.MonkeyPatch, *paths: str) -> None:
    allowed = os.access
    monkeypatch.setattr(os, "access", lambda path, mode: str(path) not in paths and allowed(path, mode))


def test_on_this_machine_it_says_something_of_everything_and_that_runs_are_possible() -> None:
    done = teleop("doctor")
    assert done.returncode == 0, done.stdout
    assert done.stderr == ""
    said = {line.split()[1] for line in done.stdout.splitlines()[:-1] if line[:2] in ("ok", "--", "!!")}
    assert said >= {"python", "packages", "hid", "serial", "can", "scheduling", "timing", "disk", "terminal"}
    assert "a bare 100 Hz loop wakes" in done.stdout


def test_json_is_one_object_for_programs() -> None:
    done = teleop("doctor", "--json")
    report = json.loads(done.stdout)
    assert (done.returncode, report["ok"]) == (0, True)
    assert {tuple(each) for each in report["findings"]} == {("about", "state", "found", "todo", "rules")}


def test_a_pad_that_may_not_be_opened_gets_its_udev_rule_exactly(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    plugged(tmp_path, "hidraw0", PAD, PAD_DESCRIPTOR)
    plugged(tmp_path, "hidraw1", PAD.replace("0B13", "0001"), KEYBOARD_DESCRIPTOR)
    plugged(tmp_path, "hidraw2", "nonsense", PAD_DESCRIPTOR)
    monkeypatch.setattr(doctor_devices, "HIDRAW", tmp_path)
    forbid(monkeypatch, "/dev/hidraw0", "/dev/hidraw1", "/dev/hidraw2")
    [finding] = doctor_devices.hid()
    assert (finding.state, finding.found) == (State.PROBLEM, "no permission to open /dev/hidraw0")
    doctor._print([finding])
    assert capsys.readouterr().out.splitlines() == [
        "!!  hid        no permission to open /dev/hidraw0: write these lines into /etc/udev/rules.d/70-teleop.rules,"
        " then: sudo udevadm control --reload && sudo udevadm trigger",
        'KERNEL=="hidraw*", KERNELS=="0005:045E:0B13.*", MODE="0660", GROUP="input", TAG+="uaccess"',
        "1 thing is in the way",
    ]


def test_a_keyboard_that_may_not_be_opened_is_no_pad_that_may(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plugged(tmp_path, "hidraw1", PAD, KEYBOARD_DESCRIPTOR)
    monkeypatch.setattr(doctor_devices, "HIDRAW", tmp_path)
    forbid(monkeypatch, "/dev/hidraw1")
    [finding] = doctor_devices.hid()
    assert (finding.state, finding.found) == (State.NOTE, "only keyboards and mice here: they need no permission")
    assert "udev rule" in finding.todo


def test_a_serial_port_that_may_not_be_opened_gets_a_rule_and_one_on_the_board_does_not_count(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("ttyACM0", "ttyS0"):
        (tmp_path / name / "device/driver").mkdir(parents=True)
    (tmp_path / "ttyUSB7").mkdir()
    monkeypatch.setattr(doctor_devices, "SERIAL", tmp_path)
    forbid(monkeypatch, "/dev/ttyACM0", "/dev/ttyS0")
    [finding] = doctor_devices.serial()
    assert (finding.state, finding.found) == (State.PROBLEM, "no permission to open /dev/ttyACM0")
    assert finding.rules == [
        'SUBSYSTEM=="tty", KERNEL=="ttyACM*|ttyUSB*", MODE="0660", GROUP="dialout", TAG+="uaccess"'
    ]


def test_a_can_interface_that_is_down_says_how_to_start_it(monkeypatch: pytest.MonkeyPatch) -> None:
    down = devices.Device("can", ("socketcan:can0",), "down: sudo ip link set can0 up type can bitrate 1000000")
    up = devices.Device("can", ("socketcan:can1",), "up")
    monkeypatch.setattr(doctor_devices, "kernel_can", lambda: devices.Listing([down, up]))
    monkeypatch.setattr(doctor_devices, "vendor_can", lambda: devices.Listing(notes=["CAN: no answer"]))
    assert [(each.state, each.found, each.todo) for each in doctor_devices.can_adapters()] == [
        (State.PROBLEM, "socketcan:can0 is down", "sudo ip link set can0 up type can bitrate 1000000"),
        (State.OK, "socketcan:can1 (up)", ""),
        (State.NOTE, "CAN: no answer", ""),
    ]


@pytest.mark.parametrize(("late", "state"), [(0.0002, State.OK), (0.005, State.NOTE), (0.02, State.PROBLEM)])
def test_lateness_is_judged_by_the_tick(late: float, state: State, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []

    def slept(ticks: int) -> Sequence[float]:
        asked.append(ticks)
        return [0.0001] * (ticks - 5) + [late] * 5

    monkeypatch.setattr(doctor_timing, "sleep_late", slept)
    [finding] = doctor_timing.lateness()
    assert asked == [200]
    assert finding.state is state
    assert f"0.10 / {1000 * late:.2f} / {1000 * late:.2f} ms late" in finding.found


def test_lateness_is_measured_against_a_grid() -> None:
    late = doctor_timing.sleep_late(5)
    assert len(late) == 5
    assert all(0 <= each < 5 for each in late)


def test_real_time_that_is_not_permitted_is_left_as_it_was_and_said(monkeypatch: pytest.MonkeyPatch) -> None:
    before = os.sched_getscheduler(0)

    def refuse(*_arguments: object) -> None:
        raise PermissionError

    list(doctor_timing.scheduling())
    assert os.sched_getscheduler(0) == before
    monkeypatch.setattr(os, "sched_setscheduler", refuse)
    first, *_ = doctor_timing.scheduling()
    assert first.state is State.NOTE
    assert "rtprio 50' | sudo tee /etc/security/limits.d/teleop.conf" in first.todo


def test_a_user_without_a_name_is_named_by_number(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_arguments: object) -> None:
        raise PermissionError

    monkeypatch.setattr(os, "sched_setscheduler", refuse)
    monkeypatch.setattr(os, "getuid", lambda: 4242424)
    first, *_ = doctor_timing.scheduling()
    assert "echo ':4242424 - rtprio 50'" in first.todo


def test_a_directory_that_was_deleted_is_a_problem(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    [finding] = doctor_machine.disk()
    assert (finding.state, finding.found) == (
        State.PROBLEM,
        "this directory cannot be used: No such file or directory",
    )


def test_a_full_disk_is_a_problem_but_stops_no_run(monkeypatch: pytest.MonkeyPatch) -> None:
    usage = type(shutil.disk_usage("."))(total=10**12, used=10**12, free=10**6)
    monkeypatch.setattr(shutil, "disk_usage", lambda _path: usage)
    [finding] = doctor_machine.disk()
    assert (finding.state, finding.found.split(" for")[0]) == (State.PROBLEM, "0.0 GB free")


@pytest.mark.parametrize(("package", "code"), [("ruckig", 1), ("hidapi", 0)])
def test_only_what_makes_every_run_impossible_is_a_failure(
    package: str, code: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(doctor_machine.PACKAGES, package, "no_such_module")
    monkeypatch.setattr(doctor, "CHECKS", (doctor_machine.packages,))
    assert run(["doctor"]) == code
    said = capsys.readouterr().out
    assert f"packages   {package}: No module named 'no_such_module': pip install" in said
    assert said.startswith("XX" if code else "!!")
    assert run(["doctor", "--json"]) == code
    assert json.loads(capsys.readouterr().out)["ok"] is (code == 0)


def test_a_problem_is_one_line() -> None:
    assert all(
        "\n" not in each.found + each.todo
        for check in (doctor_devices.hid, doctor_devices.serial, doctor_machine.disk)
        for each in check()
    )
    assert isinstance(next(doctor_machine.python()), Finding)
