"""A message class made for what the real ones do not have all at once."""

from __future__ import annotations

import dataclasses
from typing import Annotated, ClassVar

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.dji.fields import I16, U8, U16, Bits, Flag, Reserved
from teleop.dji.message import FieldError, Message, Opaque, message


@message("test.mixture", 0x7F, 0x01)
class Mixture(Message):
    """A constant between fields, and two bytes of bits apart."""

    first: Annotated[int, Bits(first=0, width=3)]
    second: Annotated[bool, Flag(first=7)]
    reserved: Annotated[int, Reserved()]
    kind: ClassVar[Annotated[int, U16()]] = 0x0201
    third: Annotated[float, U8(scale=2)]
    plain: Annotated[int, I16()]
    low: Annotated[int, Bits(first=0, width=4)]
    high: Annotated[int, Bits(first=4, width=4)]


def test_layout_of_constants_and_shared_bytes() -> None:
    sent = Mixture(first=5, second=True, reserved=0x48, third=1.5, plain=-2, low=0xB, high=0xA)
    assert sent.data() == bytes.fromhex("7f01 cd 0102 03 feff ab")
    assert Mixture.decode(sent.encode() + b"!") == dataclasses.replace(sent, extra=b"!")
    wrong = sent.encode().replace(b"\x01\x02", b"\x01\x03")
    assert Mixture.decode(wrong) == Opaque(b"\x7f\x01", wrong)


@given(st.binary(min_size=7, max_size=9).map(lambda value: value[:1] + b"\x01\x02" + value[3:]))
def test_every_bit_of_a_value_is_kept(value: bytes) -> None:
    received = Mixture.decode(value)
    assert isinstance(received, Mixture)
    assert received.encode() == value


@pytest.mark.parametrize(("field", "value"), [("first", 8), ("first", -1), ("reserved", 1), ("low", 16), ("high", 16)])
def test_bits_never_spill_into_their_neighbours(field: str, value: int) -> None:
    usual = Mixture(first=0, second=False, reserved=0, third=0.0, plain=0, low=0, high=0)
    with pytest.raises(FieldError, match=r"test\.mixture: "):
        dataclasses.replace(usual, **{field: value}).encode()
