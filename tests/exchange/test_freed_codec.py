"""FreeD D1 byte by byte: by the maker's document, and by what receivers of others read in it."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from teleop.exchange.freed.codec import ANGLE, D1, PLACE, FreeDError, decode, encode

ZEROS = bytes.fromhex("d1" + 27 * "00" + "6f")


def test_a_message_of_zeros_ends_with_the_sum_of_the_document():
    assert encode(D1(0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)) == ZEROS


def test_each_field_has_its_place_and_unit():
    message = D1(1, 90.0, -45.0, 1.5, 1.0, -2.0, 1.6, 0x010203, 0xFEDCBA, 0x1234)
    words = ["d1", "01", "2d0000", "e98000", "00c000", "00fa00", "fe0c00", "019000", "010203", "fedcba", "1234"]
    body = bytes.fromhex("".join(words))
    assert encode(message) == body + bytes([(0x40 - sum(body)) % 256])


@pytest.mark.parametrize(
    ("angle", "bytes_"),
    [(180.0, "5a0000"), (-180.0, "a60000"), (181.0, "a68000"), (359.0, "ff8000"), (720.0, "000000")],
)
def test_angles_wrap_at_half_a_turn(angle, bytes_):
    assert encode(D1(1, angle, 0, 0, 0, 0, 0))[2:5].hex() == bytes_


def test_what_has_no_room_is_cut():
    cut = encode(D1(1, 0, 0, 0, 1000.0, -1000.0, 0, -5, 1 << 30))
    assert cut[11:14].hex() == "7fffff"
    assert cut[14:17].hex() == "800000"
    assert (cut[20:23].hex(), cut[23:26].hex()) == ("000000", "ffffff")


def test_the_checksum_that_some_senders_make_is_taken_and_noticed():
    message = bytearray(encode(D1(3, 10.0, 5.0, 0, 1, 2, 3)))
    assert decode(bytes(message)).by_the_book
    message[28] = (0x100 - sum(message[:28])) & 0xFF
    assert decode(bytes(message)) == (decode(encode(D1(3, 10.0, 5.0, 0, 1, 2, 3))).message, False)


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b"", "has 0 bytes"),
        (ZEROS + b"\0", "has 30 bytes"),
        (b"\xd0" + ZEROS[1:], "is of type D0"),
        (ZEROS[:-1] + b"\x70", "has a wrong checksum"),
    ],
)
def test_what_is_no_message_says_why(data, why):
    with pytest.raises(FreeDError, match=why):
        decode(data)


angles = st.floats(-179.99, 179.99)
places = st.floats(-131.0, 131.0)
counts = st.integers(0, 0xFFFFFF)


@given(st.builds(D1, st.integers(0, 255), *3 * [angles], *3 * [places], counts, counts, st.integers(0, 0xFFFF)))
@settings(max_examples=100)
def test_a_message_comes_back_within_its_resolution(message):
    back = decode(encode(message)).message
    for index in range(1, 4):
        assert math.isclose(back[index], message[index], abs_tol=0.5 / ANGLE + 1e-9)
    for index in range(4, 7):
        assert math.isclose(back[index], message[index], abs_tol=0.5 / PLACE + 1e-9)
    assert back[7:] == message[7:]
    assert back.camera == message.camera


def unreal(data: bytes, at: int) -> float:
    """A 24-bit angle as Unreal's Live Link FreeD reads it (LiveLinkFreeDSource.cpp): one count beside for negatives."""
    counts = int.from_bytes(data[at : at + 3], "big")
    return (counts - 0xFFFFFF if data[at] & 0x80 else counts) / 32768


@given(angles, angles)
@settings(max_examples=50)
def test_unreal_reads_the_same_angles(pan, tilt):
    data = encode(D1(1, pan, tilt, 0, 0, 0, 0))
    assert (unreal(data, 2), unreal(data, 5)) == pytest.approx((pan, tilt), abs=1.6 / 32768)
