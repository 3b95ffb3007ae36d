"""Which interfaces are one device, and which device an input of the profile stands for."""

from __future__ import annotations

from fake_hid import JOYSTICK

from teleop.config.inputs_section import DeviceSection
from teleop.inputs.hid.backend import DeviceInfo
from teleop.inputs.hid.selection import together, wanted

PAD = DeviceInfo(b"/dev/hidraw0", 0x1234, 0x5678, "", "Pad", *JOYSTICK, 0, port="1-2")
MOUSE = PAD._replace(path=b"/dev/hidraw9", product_id=1, usage_page=0x01, usage=0x02)


def test_the_interfaces_of_a_device_go_together_and_devices_of_one_model_do_not() -> None:
    other, second = PAD._replace(path=b"1", port="1-3"), PAD._replace(path=b"2", interface=1)
    assert together([PAD, other, second]) == [[PAD, second], [other]]


def test_with_no_port_and_no_serial_number_two_interfaces_are_one_device_and_two_of_one_number_are_not() -> None:
    unplaced = [PAD._replace(path=b"%d" % index, port="", interface=index) for index in (0, 1)]
    assert together(unplaced) == [unplaced]
    for number in (0, -1):
        alike = [each._replace(interface=number) for each in unplaced]
        assert together(alike) == [[each] for each in alike], "nothing says that they are one"


def test_a_device_is_there_once_however_many_usages_its_interfaces_have() -> None:
    second = PAD._replace(path=b"2", interface=1)
    assert together([PAD, PAD._replace(usage=5), second, second._replace(usage=5)]) == [[PAD, second]]


def test_any_joystick_is_never_a_mouse() -> None:
    assert wanted(DeviceSection(), [MOUSE, PAD], None) == [PAD]
    assert wanted(DeviceSection(), [MOUSE], None) == []


def test_after_an_unplugging_the_same_device_comes_before_a_spare_and_what_was_there_all_along_is_not_meant() -> None:
    same, spare = PAD._replace(path=b"1"), PAD._replace(path=b"0", product_id=2)
    assert wanted(DeviceSection(), [spare, same], PAD) == [same, spare]
    assert wanted(DeviceSection(), [spare, same], PAD, stayed=[b"0"]) == [same]
