"""Fields: which control they are called after, and whether their bits are signed."""

from __future__ import annotations

from typing import Any

import pytest

from teleop.inputs.hid.descriptor.fields import Field
from teleop.inputs.hid.descriptor.usages import Range, Usages


def field(minimum: int = 0, maximum: int = 255, **more: Any) -> Field:
    return Field(0, 0, 8, 0x01, 0x30, minimum, maximum, relative=False, has_null=False, **more)


@pytest.mark.parametrize(("minimum", "signed"), [(-1, True), (0, False), (1, False)])
def test_a_field_is_signed_when_its_minimum_is_below_0(minimum: int, signed: bool) -> None:
    assert field(minimum).signed is signed


def test_a_field_is_called_after_its_usage_unless_it_has_a_label() -> None:
    assert field().name == "X"
    assert field(label="X 2").name == "X 2"


def test_a_control_of_an_array_may_have_a_name_of_its_own() -> None:
    array = field(usages=Usages([Range(0x09, 1, 2)]), count=2, array_names={(0x09, 2): "Button 2 2"})
    assert [array.array_name(0x09, number) for number in (1, 2)] == ["Button 1", "Button 2 2"]
    assert array.array_name(0x07, 2) == field().array_name(0x07, 2) != "Button 2 2", "of another page"


def test_two_fields_that_are_alike_are_two() -> None:
    one, other = field(), field()
    assert one != other
    assert len({one, other}) == 2
