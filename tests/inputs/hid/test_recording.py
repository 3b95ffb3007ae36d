"""Recordings: what is wrong with one, and the device that plays it as it was."""

from __future__ import annotations

import json
import math
from pathlib import Path
from time import monotonic
from typing import Any

import pytest
from fake_hid import FakeBackend, FakeDevice, real
from waiting import wait_until

from teleop.config.documents.document import DocumentError
from teleop.config.inputs_section import InputSection
from teleop.core.axes import Axis
from teleop.inputs.hid.backend import DeviceInfo
from teleop.inputs.hid.device import open_inputs
from teleop.inputs.hid.recording import MAX_PROBLEMS, RecordedDevice, RecordedDevices, Recording, Row, read_recording

HEAD: dict[str, Any] = {"device": {"vendor": "046d", "product": "c216"}, "descriptor": "05"}
PAD = DeviceInfo(b"recording 1", 0x046D, 0xC216, "", "Pad", 1, 4, 0)
BEGIN = 100.0  # of the run, on its clock


def written(folder: Path, *records: object) -> Path:
    file = folder / "pad.jsonl"
    file.write_text("".join(json.dumps(record) + "\n" for record in records))
    return file


def problems(file: Path) -> list[str]:
    with pytest.raises(DocumentError) as refused:
        read_recording(file)
    return [line.removeprefix(str(file)) for line in str(refused.value).splitlines()]


class Time:
    def __init__(self, now: float) -> None:
        self.now = now

    def __call__(self) -> float:
        return self.now


def opened(time: Time, *rows: Row) -> RecordedDevice:
    device = RecordedDevices([Recording([PAD], b"\x05", rows)], time, lambda: BEGIN).open(PAD.path)
    assert isinstance(device, RecordedDevice)
    return device


def test_every_row_that_is_wrong_is_told_with_its_line(tmp_path: Path) -> None:
    rows = [{"time": 2, "report": "01"}, {"time": 1, "report": "01"}, {"time": 3, "report": ""}, {"time": True}]
    assert problems(written(tmp_path, HEAD, *rows, {"time": 4})) == [
        ":3: time must not be before that of the row above (2 s)",
        ':4: "report" must have a byte at least',
        ':5: "time" must be 0 s or later, not True',
        ':6: "report" must be hexadecimal, not None',
    ]


def test_a_file_full_of_mistakes_is_not_told_without_end(tmp_path: Path) -> None:
    told = problems(written(tmp_path, HEAD, *[{"time": -1}] * (MAX_PROBLEMS + 3)))
    assert len(told) == MAX_PROBLEMS + 1
    assert told[-1] == ": and 3 more"


@pytest.mark.parametrize(
    ("device", "problem"),
    [
        ({"vendor": "46dx"}, "\"vendor\" must be four hexadecimal digits, not '46dx'"),
        ({"product": "1c216"}, "\"product\" must be four hexadecimal digits, not '1c216'"),
        ({"usages": [[1, 4], [1]]}, '"usages" must be a list of [page, usage], of 256 at most'),
        ({"interface": "0"}, "\"interface\" must be a number, not '0'"),
    ],
)
def test_a_device_that_cannot_be_one_is_refused(tmp_path: Path, device: dict[str, Any], problem: str) -> None:
    file = written(tmp_path, {**HEAD, "device": {**HEAD["device"], **device}})
    assert problems(file) == [f":1: device: {problem}"]


def test_what_is_no_text_is_refused(tmp_path: Path) -> None:
    (tmp_path / "pad.jsonl").write_bytes(b"\xff\xfe\x00")
    assert problems(tmp_path / "pad.jsonl") == [": is not text; a recording is JSON lines"]


def test_a_device_gives_each_report_at_its_time_and_then_nothing_more() -> None:
    time = Time(BEGIN)
    device = opened(time, Row(0.5, b"\x01\x02"), Row(0.75, b"\x01\x03"))
    assert device.next_report == BEGIN + 0.5
    assert device.read(0) == b"\x01\x02"
    assert device.next_report == BEGIN + 0.75
    time.now = BEGIN + 0.75
    assert device.read(0.05) == b"\x01\x03"
    assert (device.read(0), device.next_report) == (b"", math.inf)


def test_it_answers_with_the_last_report_of_the_id_that_is_asked_for() -> None:
    device = opened(Time(BEGIN), Row(0.0, b"\x01\x02\x03"), Row(0.0, b"\x02\x04"))
    with pytest.raises(OSError, match="no answer"):
        device.get_input_report(1, 8)
    device.read(0)
    device.read(0)
    assert device.get_input_report(1, 2) == b"\x01\x02"
    assert device.get_input_report(0, 8) == b"\x02\x04", "without ids it is the last of all"
    with pytest.raises(OSError, match="no answer"):
        device.get_input_report(3, 8)


def test_one_that_is_opened_in_the_middle_has_missed_what_came_before() -> None:
    device = opened(Time(BEGIN + 2), Row(1.0, b"\x01"), Row(3.0, b"\x02"))
    assert device.next_report == BEGIN + 3


def test_when_asked_it_answers_with_what_it_reported_since_it_was_plugged_in() -> None:
    rows = [Row(1.0, b"\x01"), Row(2.0, gone=True), Row(3.0), Row(3.1, b"\x02\x03")]
    devices = RecordedDevices([Recording([PAD], b"\x05", rows)], (time := Time(3.05)), lambda: 0.0)
    with pytest.raises(OSError, match="no answer"):
        devices.open(PAD.path).get_input_report(0, 8)
    time.now = 4.0
    assert devices.open(PAD.path).get_input_report(0, 8) == b"\x02\x03"


def test_a_device_that_is_there_from_the_beginning_is_opened_before_its_first_report() -> None:
    devices = RecordedDevices([Recording([PAD], b"\x05", [Row(0.0, b"\x01")])], Time(BEGIN + 0.008), lambda: BEGIN)
    assert devices.open(PAD.path).read(0) == b"\x01"


@pytest.mark.parametrize(
    ("time", "problem"),
    [
        ("9" * 400, '"time" must be 86400 s at most'),
        ("1.7e9", '"time" must be 86400 s at most'),
        ("1e999", '"time" must be 86400 s at most'),
        ("NaN", '"time" must be 0 s or later, not nan'),
    ],
)
def test_a_time_that_no_run_comes_to_is_refused(tmp_path: Path, time: str, problem: str) -> None:
    file = written(tmp_path, HEAD)
    file.write_text(f'{file.read_text()}{{"time": {time}, "report": "00"}}\n')
    [line] = problems(file)
    assert line.startswith(f":2: {problem}")


def test_a_line_about_a_wrong_value_is_short(tmp_path: Path) -> None:
    wrong = [{"time": "9" * 10_000, "report": "00"}, {"time": 0, "report": ["x"] * 10_000}]
    assert all(len(line) < 150 for line in problems(written(tmp_path, HEAD, *wrong)))


def test_what_a_device_says_of_itself_is_no_command_for_the_terminal(tmp_path: Path) -> None:
    device = HEAD["device"] | {"name": "P\x1b[2Ja\nd\ud800", "serial": "1\r2"}
    [info] = read_recording(written(tmp_path, HEAD | {"device": device})).infos
    assert (info.name, info.serial) == ("P[2Jad", "12")


def test_a_line_ends_only_at_its_end(tmp_path: Path) -> None:
    file = tmp_path / "pad.jsonl"
    text = json.dumps(HEAD | {"device": HEAD["device"] | {"name": "A\u2028B"}}, ensure_ascii=False)
    file.write_text(text, encoding="utf-8")
    assert read_recording(file).infos[0].name == "AB"


@pytest.mark.parametrize(
    ("rows", "times"),
    [
        ([Row(1.0, b"\x01"), Row(2.0, gone=True), Row(3.0)], {-math.inf: 1, 0.0: 1, 1.9: 1, 2.0: 0, 2.9: 0, 3.0: 1}),
        ([Row(1.0), Row(2.0, b"\x01")], {-math.inf: 0, 0.9: 0, 1.0: 1, 9.0: 1}),
        ([], {-math.inf: 1, 9.0: 1}),
    ],
)
def test_a_device_is_listed_and_opened_while_it_was_plugged_in(rows: list[Row], times: dict[float, int]) -> None:
    for now, there in times.items():
        backend = RecordedDevices([Recording([PAD], b"\x05", rows)], Time(now), lambda: 0.0)
        assert backend.enumerate() == [PAD] * there, now
        if not there:
            with pytest.raises(OSError, match="unplugged"):
                backend.open(PAD.path)


def test_devices_that_are_really_there_are_beside_the_recorded() -> None:
    pad = FakeDevice(b"\x05")
    recorded = [Recording([PAD], b"\x05", [])]
    backend = RecordedDevices(recorded, Time(0), lambda: 0.0, FakeBackend(pad))
    assert backend.enumerate() == [PAD, pad.info]
    assert backend.open(pad.info.path) is pad
    with pytest.raises(OSError, match="no such device"):
        RecordedDevices(recorded, Time(0), lambda: 0.0).open(pad.info.path)


def test_a_recording_plays_in_real_time_beside_a_device_that_is_really_there() -> None:
    """Each is read by a thread of its own: the recorded one by the clock, the real one when it reports."""
    descriptor = bytes.fromhex(real("Logitech F310")["descriptor"])
    rest, right = bytes.fromhex("7f7f7f7f08000000"), bytes.fromhex("ff7f7f7f08000000")
    rows = [Row(index / 100, rest if index < 60 else right) for index in range(6000)]
    pad = FakeDevice(descriptor, name="Real", path=b"/dev/hidraw0")
    recorded = Recording([PAD._replace(name="Recorded")], descriptor, rows)
    begin = monotonic()
    backend = RecordedDevices([recorded], monotonic, lambda: begin, FakeBackend(pad))
    sections = [{"device": {"name": "Recorded"}}, {"device": {"name": "Real"}, "controls": {"X": {"axis": "tilt"}}}]
    with open_inputs([InputSection.model_validate(each) for each in sections], monotonic, backend) as inputs:

        def asks(number: int, report: bytes, axis: Axis, deflection: float) -> bool:
            pad.report(report)
            held = inputs[number].read(monotonic())
            return not held.trouble and held.deflections.get(axis) == deflection

        wait_until(lambda: asks(1, rest, Axis.TILT, 0), "the real one at rest")
        wait_until(lambda: asks(0, rest, Axis.PAN, 1), "the recorded one pushed")
        wait_until(lambda: asks(1, right, Axis.TILT, 1), "the real one pushed")
