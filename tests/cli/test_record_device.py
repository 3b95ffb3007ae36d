"""`teleop devices record`: which device is meant, and what is written of it."""

from __future__ import annotations

from pathlib import Path

import pytest
from fake_hid import JOYSTICK, KEYBOARD, FakeBackend, FakeDevice, real

from teleop.cli import record_device, run
from teleop.cli.record_device import chosen
from teleop.core.errors import UsageError
from teleop.inputs.hid.recording import read_recording

DESCRIPTOR = bytes.fromhex(real("Logitech F310")["descriptor"])
REST = bytes.fromhex("7f7f7f7f08000000")


def device(name: str, ids: tuple[int, int], path: bytes, usage: tuple[int, int] = JOYSTICK) -> FakeDevice:
    return FakeDevice(DESCRIPTOR, ids, name, usage, path, serial="S1")


class Interrupting(FakeDevice):
    """Somebody presses Ctrl-C once its reports have been read."""

    def read(self, timeout: float) -> bytes:
        if self._given == self._taken:
            raise KeyboardInterrupt
        return super().read(timeout)


@pytest.fixture
def pad(monkeypatch: pytest.MonkeyPatch) -> Interrupting:
    """The only device of this machine, with two reports to give."""
    pad = Interrupting(DESCRIPTOR, (0x46D, 0xC216), "Logitech F310", JOYSTICK, serial="S1")
    pad.report(REST, REST)
    monkeypatch.setattr(record_device, "AllDevices", lambda: FakeBackend(pad))
    return pad


@pytest.mark.parametrize(
    ("meant", "path"),
    [
        ("", b"/dev/hidraw1"),
        ("046D:c216", b"/dev/hidraw2"),
        ("46d:c31c", b"/dev/hidraw0"),
        ("/dev/hidraw2", b"/dev/hidraw2"),
        ("logitech f*", b"/dev/hidraw2"),
        ("Dial [USB]", b"/dev/hidraw3"),
    ],
)
def test_a_device_is_meant_by_ids_path_or_name_and_else_it_is_the_first_joystick(meant: str, path: bytes) -> None:
    backend = FakeBackend(
        device("Keyboard", (0x46D, 0xC31C), b"/dev/hidraw0", KEYBOARD),
        device("Stick", (0x44F, 0xB10A), b"/dev/hidraw1"),
        device("Logitech F310", (0x46D, 0xC216), b"/dev/hidraw2"),
        device("Dial [USB]", (0x1234, 0x5678), b"/dev/hidraw3"),
    )
    assert [info.path for info in chosen(backend, meant)] == [path]


def test_each_usage_of_the_device_is_there_and_no_other_devices() -> None:
    usages = [device("Pad", (1, 2), b"/dev/hidraw0", usage) for usage in (KEYBOARD, JOYSTICK)]
    other = device("Pad", (1, 2), b"/dev/hidraw1")
    infos = chosen(FakeBackend(*usages, other), "1:2")
    assert [(info.path, (info.usage_page, info.usage)) for info in infos] == [
        (b"/dev/hidraw0", JOYSTICK),
        (b"/dev/hidraw0", KEYBOARD),
    ]


@pytest.mark.parametrize(
    ("meant", "said"), [("", "no joystick found: plug one in"), ("1:2", "no device 1:2"), ("Pad", "no device Pad")]
)
def test_what_is_not_there_is_said_with_where_to_look(meant: str, said: str) -> None:
    backend = FakeBackend(device("Keyboard", (0x46D, 0xC31C), b"/dev/hidraw0", KEYBOARD))
    with pytest.raises(UsageError) as caught:
        chosen(backend, meant)
    assert str(caught.value) == f"{said}; `teleop devices` lists the devices"


@pytest.mark.parametrize("serial", [False, True])
def test_ctrl_c_ends_a_recording_that_can_be_read(
    serial: bool, pad: Interrupting, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "pad.jsonl"
    assert not run(["devices", "record", "-o", str(file), *(["--serial"] if serial else [])])
    recording = read_recording(file)
    assert [row.report for row in recording.rows] == [REST, REST]
    assert [info.serial for info in recording.infos] == ["S1" if serial else ""]
    assert "and 2 reports with their times" in capsys.readouterr().err
    assert (pad.opened, pad.closed) == (1, 1)


def test_a_file_that_is_there_is_kept_and_a_device_that_cannot_be_opened_leaves_none(
    pad: Interrupting, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mine = tmp_path / "mine.jsonl"
    mine.write_text("mine")
    assert run(["devices", "record", "-o", str(mine)]) == 2
    assert mine.read_text() == "mine"
    pad.may_be_opened = False
    assert run(["devices", "record", "-o", str(tmp_path / "new.jsonl")]) == 1
    assert "Logitech F310: cannot be opened (open failed): check its udev rule" in capsys.readouterr().err
    assert not (tmp_path / "new.jsonl").exists()


def test_one_report_is_one(pad: Interrupting, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pad.read(0)
    assert not run(["devices", "record", "-o", str(tmp_path / "pad.jsonl")])
    assert "and 1 report with its time\n" in capsys.readouterr().err
