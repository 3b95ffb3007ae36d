"""A wired pad in the hand through the very code of HID inputs: mapping, trust, centers, unplugging; never twice."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from fake_evdev import ABS, EAST, KEY, MENU, SOUTH, FakeEvents, FakeMachine, X, Z
from fake_hid import FakeBackend, FakeDevice, real
from waiting import wait_until

from teleop.config.inputs_section import InputSection
from teleop.core.axes import Axis
from teleop.core.errors import DeviceError
from teleop.core.operator_input import Command, Held
from teleop.inputs.evdev import backend as evdev_backend
from teleop.inputs.evdev.backend import INSTALL, AllDevices, EventBackend, open_events
from teleop.inputs.hid import reader as hid_reader
from teleop.inputs.hid.device import HidInput, open_inputs

F310 = real("Logitech F310")
HID = "0003:046D:C216.0001"


@pytest.fixture(autouse=True)
def _look_often(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hid_reader, "LOOK_EVERY", 0.01)


@pytest.fixture
def machine(tmp_path: Path) -> FakeMachine:
    return FakeMachine(tmp_path)


class Hand:
    def __init__(self, machine: FakeMachine, pad: HidInput) -> None:
        self.machine, self.pad, self.now = machine, pad, 100.0
        self.presses: list[Command] = []

    def read(self) -> Held:
        held = self.pad.read(self.now)
        self.presses += [press.command for press in held.presses]
        return held

    def trouble(self, ending: str) -> Held:
        return self.until(lambda held: held.trouble.endswith(ending))

    def until(self, holds: object) -> Held:
        seen: list[Held] = []

        def check() -> object:
            seen.append(self.read())
            return holds(seen[-1])  # type: ignore[operator]

        wait_until(check, "what the hand is to do")
        return seen[-1]

    def center(self) -> None:
        self.trouble("finding its center: release the sticks")
        self.now += 0.3
        self.until(lambda held: not held.trouble)


@pytest.fixture
def hand(machine: FakeMachine) -> Iterator[Hand]:
    hands = Hand(machine, None)  # type: ignore[arg-type]
    with open_inputs([InputSection()], lambda: hands.now, AllDevices(FakeBackend(), machine.backend)) as [pad]:
        hands.pad = pad
        yield hands


def test_a_wired_xbox_pad_drives_by_its_mapping_and_its_buttons_stop(hand: Hand) -> None:
    pad = FakeEvents()
    hand.machine.plug(pad)
    hand.center()
    assert hand.pad.name == "Microsoft X-Box One pad"
    pad.frame((ABS, X, 32767))
    assert hand.until(lambda held: held.deflections.get(Axis.PAN)).deflections[Axis.PAN] == 1.0
    pad.frame((ABS, X, 0), (ABS, Z, 1023))
    assert hand.until(lambda held: held.deflections.get(Axis.FOCUS)).deflections[Axis.FOCUS] == -1.0
    for count, key in enumerate((EAST, MENU, SOUTH), 1):
        pad.frame((KEY, key, 1))
        pad.frame((KEY, key, 0))
        hand.until(lambda held, count=count: len(hand.presses) == count)
    assert hand.presses == [Command.STOP, Command.CLEAR, Command.RECORD]
    assert pad.grabbed == 0


def test_at_rest_its_silence_is_no_trouble_and_deflected_it_is_asked(hand: Hand) -> None:
    pad = FakeEvents()
    hand.machine.plug(pad)
    hand.center()
    hand.now += 60
    assert hand.read().trouble == ""
    pad.frame((ABS, X, 32767))
    hand.until(lambda held: held.deflections.get(Axis.PAN))
    hand.now += 0.15
    hand.until(lambda held: hand.pad._plugged.state.last == hand.now)  # type: ignore[union-attr]
    assert hand.read().trouble == ""


def test_torn_out_in_a_pan_it_is_unplugged_and_comes_back_with_another_number(hand: Hand) -> None:
    pad = FakeEvents()
    path = hand.machine.plug(pad)
    hand.center()
    pad.frame((ABS, X, 32767))
    hand.until(lambda held: held.deflections.get(Axis.PAN))
    hand.machine.unplug(path)
    held = hand.trouble("unplugged")
    assert held.deflections == {}
    again = FakeEvents()
    hand.machine.plug(again, 9)
    hand.until(lambda held: not held.trouble)  # its center is known
    again.frame((ABS, X, -32768))
    assert hand.until(lambda held: held.deflections.get(Axis.PAN)).deflections[Axis.PAN] == -1.0


def test_one_that_may_not_be_opened_is_refused_with_its_place_and_the_cure(
    hand: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("os.access", lambda path, mode: not str(path).endswith("event5"))
    hand.machine.plug(FakeEvents())
    held = hand.until(lambda held: "Permission denied" in held.trouble)  # not half plugged in
    assert "event5" in held.trouble
    assert held.trouble.endswith("check its udev rule: teleop doctor")


def f310(path: Path) -> FakeDevice:
    ids = F310["vendor_id"], F310["product_id"]
    return FakeDevice(bytes.fromhex(F310["descriptor"]), ids, "Logitech", path=bytes(path))


def test_no_device_is_listed_twice(machine: FakeMachine, monkeypatch: pytest.MonkeyPatch) -> None:
    hid = f310(machine.dev / "hidraw0")
    event = machine.plug(
        FakeEvents(), ids=hid.info[1:3], parent=HID, driver="hid-generic", hidraw=["hidraw0"], name="Logitech"
    )
    devices = AllDevices(FakeBackend(hid), machine.backend)
    assert [info.path for info in devices.enumerate()] == [hid.info.path]
    monkeypatch.setattr("os.access", lambda path, mode: "hidraw" not in str(path))
    assert [info.path for info in devices.enumerate()] == [bytes(event)]


def test_a_device_that_is_read_stays_what_it_is_when_permissions_come_later(
    machine: FakeMachine, monkeypatch: pytest.MonkeyPatch
) -> None:
    """udev opens the two nodes one after the other; another reader must not take the same device by the second."""
    hid = f310(machine.dev / "hidraw0")
    event = machine.plug(FakeEvents(), parent=HID, driver="hid-generic", hidraw=["hidraw0"])
    devices = AllDevices(FakeBackend(hid), machine.backend)
    with monkeypatch.context() as patch:
        patch.setattr("os.access", lambda path, mode: "hidraw" not in str(path))
        opened = devices.open(bytes(event))
    assert [info.path for info in devices.enumerate()] == [bytes(event)]
    opened.close()
    assert [info.path for info in devices.enumerate()] == [hid.info.path]


def test_a_shipped_mapping_by_a_descriptors_names_is_not_laid_over_a_drivers(machine: FakeMachine) -> None:
    """hid-playstation calls the right stick Rx, Ry and the triggers Z, Rz: the descriptor's Z is the right stick."""
    from teleop.inputs.hid.pads import pad_for

    machine.plug(FakeEvents(), parent="0005:054C:0CE6.0001", driver="playstation", ids=(0x054C, 0x0CE6), bus=5)
    [info] = machine.backend.enumerate()
    pad = pad_for(info)
    assert pad is not None
    assert pad.name == "PlayStation"
    assert pad_for(info._replace(driver="")).name == "DualSense"  # type: ignore[union-attr]
    assert pad_for(info._replace(driver="iforce")) is None


def test_without_the_evdev_package_the_refusal_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setitem(sys.modules, "evdev", None)
    with pytest.raises(OSError, match=r"pip install 'rs-teleop\[evdev\]'"):
        open_events(tmp_path / "event0")


def test_without_hidapi_event_devices_are_there_on_linux_alone(
    machine: FakeMachine, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse() -> FakeBackend:
        raise DeviceError("joysticks cannot be read: no hidapi")

    monkeypatch.setattr(evdev_backend, "Hidapi", refuse)
    machine.plug(FakeEvents())
    monkeypatch.setattr(sys, "platform", "linux")
    assert [info.driver for info in AllDevices(events=machine.backend).enumerate()] == ["xpad"]
    monkeypatch.setattr(sys, "platform", "darwin")
    with pytest.raises(DeviceError, match="no hidapi"):
        AllDevices(events=machine.backend)


def test_a_device_that_is_gone_when_it_is_opened_is_closed_again(machine: FakeMachine) -> None:
    pad = FakeEvents()
    path = machine.plug(pad)
    pad.gone = True
    with pytest.raises(OSError, match="No such device"):
        machine.backend.open(bytes(path))
    assert pad.closed == 1
    with pytest.raises(OSError, match="no such device"):
        EventBackend(machine.sys, machine.dev).open(b"/dev/input/event99")


@pytest.mark.parametrize(("driver", "bus"), [("nintendo", 3), ("playstation", 5)])
def test_without_the_evdev_package_a_pad_that_has_hidraw_is_read_by_it(
    machine: FakeMachine, monkeypatch: pytest.MonkeyPatch, driver: str, bus: int
) -> None:
    hid = f310(machine.dev / "hidraw0")
    event = machine.plug(FakeEvents(), parent=HID, driver=driver, bus=bus, hidraw=["hidraw0"])
    devices = AllDevices(FakeBackend(hid), machine.backend)
    assert [info.path for info in devices.enumerate()] == [bytes(event)]
    machine.backend.has_package = False
    assert [info.path for info in devices.enumerate()] == [hid.info.path]
    monkeypatch.setattr("os.access", lambda path, mode: "hidraw" not in str(path))
    assert [info.path for info in devices.enumerate()] == [bytes(event)], "hidraw may not be opened"


def test_without_the_evdev_package_a_pad_without_hidraw_is_one_line_with_the_cure(
    machine: FakeMachine, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "evdev", None)
    machine.plug(FakeEvents())
    events = EventBackend(machine.sys, machine.dev)
    with open_inputs([InputSection()], lambda: 0.0, AllDevices(FakeBackend(), events)) as [pad]:
        cure = "joystick: Microsoft X-Box One pad needs the package evdev: pip install 'rs-teleop[evdev]'"
        wait_until(lambda: pad.read(0.0).trouble == cure, "the line")


def test_without_the_evdev_package_a_switch_pro_read_by_hidraw_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(hid_reader, "missing_package", lambda: INSTALL)
    pro = FakeDevice(bytes.fromhex(F310["descriptor"]), (0x057E, 0x2009), "Pro Controller")
    with open_inputs([InputSection()], lambda: 0.0, FakeBackend(pro)) as [pad]:
        ending = f"its reports are not what its descriptor says; read its event device: {INSTALL}"
        wait_until(lambda: pad.read(0.0).trouble.endswith(ending), "the line")
