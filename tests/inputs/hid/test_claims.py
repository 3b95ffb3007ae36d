"""Claims: no two readers have one device, and each device is for the section that had it or names it best."""

from __future__ import annotations

from typing import Any

from teleop.config.inputs_section import InputSection
from teleop.inputs.hid.backend import DeviceInfo
from teleop.inputs.hid.claims import Claims

PAD = DeviceInfo(b"/dev/hidraw0", 0x046D, 0xC216, "", "Pad", 1, 4, 0, port="1-2")


def section(**device: Any) -> InputSection:
    return InputSection.model_validate({"device": device or "any"})


def test_a_device_is_taken_once_until_it_is_released() -> None:
    claims = Claims()
    assert claims.take(PAD.path)
    assert not claims.take(PAD.path)
    assert claims.take(b"/dev/hidraw1")
    claims.release(PAD.path)
    assert claims.take(PAD.path)


def test_one_that_was_not_taken_may_be_released() -> None:
    claims = Claims()
    claims.release(PAD.path)
    assert claims.take(PAD.path)


def test_a_device_that_a_section_has_had_is_for_no_other_even_when_unplugged() -> None:
    one, other = section(), section()
    claims = Claims([one, other])
    claims.remember(one, PAD)
    back = PAD._replace(path=b"/dev/hidraw7")
    assert claims.is_for_another(other, back), "in the same port"
    assert not claims.is_for_another(one, back)
    assert not claims.is_for_another(other, back._replace(port="1-3")), "a second one of that model"


def test_a_section_that_has_taken_another_device_since_gives_up_the_first() -> None:
    one, other = section(), section()
    claims = Claims([one, other])
    claims.remember(one, PAD)
    claims.remember(one, PAD._replace(port="1-3"))
    assert not claims.is_for_another(other, PAD)


def test_a_device_is_for_the_section_that_names_it_more_exactly() -> None:
    any_device, by_ids = section(), section(vendor=0x046D, product=0xC216)
    by_port = section(vendor=0x046D, product=0xC216, port="1-2")
    claims = Claims([any_device, by_ids, by_port])
    assert [claims.is_for_another(each, PAD) for each in (any_device, by_ids, by_port)] == [True, True, False]
    elsewhere = PAD._replace(port="1-3")
    assert [claims.is_for_another(each, elsewhere) for each in (any_device, by_ids)] == [True, False]


def test_of_sections_that_name_it_alike_any_may_have_it() -> None:
    one, other = section(name="Pad"), section(vendor=0x046D)
    claims = Claims([one, other])
    assert not claims.is_for_another(one, PAD)
    assert not claims.is_for_another(other, PAD)


def test_a_serial_number_or_a_port_is_more_exact_than_any_ids() -> None:
    by_ids, by_port = section(vendor=0x046D, product=0xC216, name="Pad", interface=0), section(port="1-2")
    claims = Claims([by_ids, by_port])
    assert claims.is_for_another(by_ids, PAD)
    assert not claims.is_for_another(by_port, PAD)


OTHER = PAD._replace(path=b"/dev/hidraw1", port="1-3")


def test_two_devices_of_a_model_are_in_doubt_between_two_sections_that_name_both_alike() -> None:
    one, other, any_device = section(vendor=0x046D, product=0xC216), section(vendor=0x046D, name="Pad"), section()
    claims = Claims([one, other, any_device])
    for each in (one, other):
        assert "2 of Pad are plugged in" in claims.doubt(each, PAD, [PAD, OTHER])
        assert claims.doubt(each, PAD, [PAD]) == "", "one alone is not"
        assert claims.doubt(each, PAD, [PAD, OTHER._replace(product_id=1, name="")]) == "", "nor another model"


def test_what_a_section_has_had_and_what_is_exchanged_without_a_difference_is_in_no_doubt() -> None:
    one, other = section(vendor=0x046D), section(vendor=0x046D)
    claims = Claims([one, other])
    assert claims.doubt(one, PAD, [PAD, OTHER])
    claims.remember(one, PAD)
    assert claims.doubt(one, PAD, [PAD, OTHER]) == ""
    assert claims.doubt(other, OTHER, [PAD, OTHER])
    assert Claims([one, other], exchangeable=True).doubt(one, PAD, [PAD, OTHER]) == ""
    anything = [section(), section()]
    assert Claims(anything).doubt(anything[0], PAD, [PAD, OTHER]) == ""


def test_one_device_for_two_sections_is_for_the_first_until_that_has_one() -> None:
    one, other = section(vendor=0x046D), section(name="Pad")
    claims = Claims([one, other])
    assert claims.is_for_one_before(other, PAD)
    assert not claims.is_for_one_before(one, PAD)
    claims.take(OTHER.path, one)
    assert not claims.is_for_one_before(other, PAD)
