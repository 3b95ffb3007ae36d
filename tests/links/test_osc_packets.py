"""OSC packets, judged by python-osc: the same messages, and an OscError for whatever is none."""

from __future__ import annotations

import math
import struct
from contextlib import suppress
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pythonosc.osc_bundle_builder import OscBundleBuilder
from pythonosc.osc_message import OscMessage
from pythonosc.osc_message_builder import OscMessageBuilder

from teleop.links.osc_packets import BUNDLE, LARGEST, Message, OscError, messages, packet

FLOATS = st.floats(width=32, allow_nan=False)
TEXTS = st.text(st.characters(min_codepoint=1, codec="utf-8"), max_size=12)
ARGUMENTS = st.lists(st.integers(-(2**31), 2**31 - 1) | FLOATS | TEXTS | st.booleans(), max_size=6)


def built(address: str, *arguments: Any, tags: str = "") -> bytes:
    builder = OscMessageBuilder(address)
    for number, argument in enumerate(arguments):
        builder.add_arg(argument, tags[number] if tags else None)
    return builder.build().dgram


@given(ARGUMENTS)
def test_what_is_sent_is_what_python_osc_sends_and_reads(arguments):
    data = packet("/teleop/go", *arguments)
    assert data == built("/teleop/go", *arguments)
    read = OscMessage(data)
    assert (read.address, read.params) == ("/teleop/go", arguments)
    assert messages(data) == [Message("/teleop/go", tuple(arguments))]


def test_every_type_is_read():
    data = built("/a", 1, 2.5, "x", b"abcde", 2**40, 0.1, True, False, None, tags="ifsbhdTFN")
    assert messages(data) == [Message("/a", (1, 2.5, "x", b"abcde", 2**40, 0.1, True, False, None))]
    assert messages(b"/a\0\0,[i]\0\0\0\0\0\0\0\7") == [Message("/a", (7,))]
    assert messages(b"/a\0\0") == [Message("/a")]  # from before type tags


def test_a_bundle_is_its_messages_at_once_whatever_its_time():
    inner = OscBundleBuilder(2_000_000_000)
    inner.add_content(OscMessageBuilder("/b").build())
    outer = OscBundleBuilder(1)
    outer.add_content(OscMessageBuilder("/a").build())
    outer.add_content(inner.build())
    assert [message.address for message in messages(outer.build().dgram)] == ["/a", "/b"]
    assert messages(BUNDLE + bytes(8)) == []


def test_a_number_that_is_none_is_read_and_judged_by_whom_it_concerns():
    (message,) = messages(b"/a\0\0,f\0\0" + struct.pack(">f", math.nan))
    assert math.isnan(float(message.arguments[0] or 0))


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"/go",
        b"go\0\0,\0\0\0",
        b"/go\0,i\0\0",
        b"/go\0i\0\0\0\0\0\0\1",
        b"/go\0,x\0\0",
        b"/go\0,\0\0\0\0\0\0\0",
        b"/go\0,s\0\0abcd",
        b"/go\0,b\0\0\xff\xff\xff\xff",
        b"/go\0,b\0\0\x7f\xff\xff\xff",
        b"/\xff\xfe\0,\0\0\0",
        BUNDLE,
        BUNDLE + bytes(8) + b"\0\0\0",
        BUNDLE + bytes(8) + bytes(4),
        BUNDLE + bytes(8) + b"\x7f\xff\xff\xfc",
        BUNDLE + bytes(8) + b"\xff\xff\xff\xfc",
        b"/" * (LARGEST + 4),
    ],
)
def test_what_is_no_packet_is_an_error(data):
    with pytest.raises(OscError):
        messages(data)


def test_a_packet_of_too_much_is_an_error():
    many = BUNDLE + bytes(8) + b"\0\0\0\4/a\0\0" * 65
    nested = packet("/a")
    for _ in range(5):
        nested = BUNDLE + bytes(8) + struct.pack(">i", len(nested)) + nested
    for data in (many, nested, b"/a\0\0," + b"T" * 67):
        with pytest.raises(OscError):
            messages(data)


@given(st.binary(max_size=120))
def test_no_bytes_raise_anything_else(noise):
    for data in (noise, b"/a\0\0" + noise, b"/a\0\0,ifsb\0\0\0" + noise, BUNDLE + bytes(8) + noise):
        with suppress(OscError):
            messages(data)
