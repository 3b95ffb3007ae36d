"""udev rules for what is plugged in, and for nothing that types."""

from __future__ import annotations

import pytest

from teleop.cli.doctor.udev_rules import hid_rule, serial_rule

JOYSTICK, KEYBOARD, MOUSE = b"\x05\x01\x09\x04\xa1\x01", b"\x05\x01\x09\x06\xa1\x01", b"\x05\x01\x09\x02\xa1\x01"
UEVENT = "DRIVER=hid-generic\nHID_ID=0003:0000046D:0000C21D\nHID_NAME=Pad\n"


def device(folder, descriptor, uevent=UEVENT):
    (folder / "device").mkdir()
    (folder / "device/uevent").write_text(uevent)
    (folder / "device/report_descriptor").write_bytes(descriptor)
    return folder


def test_a_pad_is_opened_by_its_own_name_alone(tmp_path):
    rule = hid_rule(device(tmp_path, JOYSTICK))
    assert 'KERNELS=="0003:046D:C21D.*"' in rule
    assert 'TAG+="uaccess"' in rule
    assert "\n" not in rule


@pytest.mark.parametrize("descriptor", [KEYBOARD, MOUSE])
def test_a_keyboard_and_a_mouse_have_no_rule(tmp_path, descriptor):
    assert hid_rule(device(tmp_path, descriptor)) == ""


def test_what_is_gone_or_says_nothing_has_no_rule(tmp_path):
    assert hid_rule(tmp_path / "gone") == ""
    assert hid_rule(device(tmp_path, JOYSTICK, "DRIVER=x\n")) == ""


def test_serial_adapters_are_opened_for_the_group_too():
    assert 'GROUP="dialout"' in serial_rule()
