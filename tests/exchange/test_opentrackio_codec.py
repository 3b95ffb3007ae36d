"""OpenTrackIO's packets byte by byte, and its samples by the standard's own schema."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import cbor2
import jsonschema
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from teleop.exchange.opentrackio.packets import CBOR, JSON, PacketError, Reassembly, fletcher16, packets, parsed
from teleop.exchange.opentrackio.sample import (
    Moment,
    Pose,
    SampleError,
    Source,
    encoded,
    identity,
    received,
    sample,
)

SCHEMA = json.loads((Path(__file__).parents[1] / "data" / "opentrackio-schema.json").read_text())
JUDGE = jsonschema.Draft202012Validator(SCHEMA, format_checker=jsonschema.FormatChecker())
SOURCE = Source(1, identity("stage", "rig", 1), 50.0, "rig", "0.2.0")
POSE = Pose(1.0, 2.0, 1.6, 30.0, -12.5, 1.25)


def by_the_standard(data: bytes) -> bytes:
    """The checksum as the standard's own C code makes it: 8-bit sums, (sum2 << 8) | sum1, big-endian."""
    sum1 = sum2 = 0
    for byte in data:
        sum1 = (sum1 + byte) & 0xFF
        sum2 = (sum2 + sum1) & 0xFF
    return struct.pack(">H", sum2 << 8 | sum1)


def test_the_checksum_is_that_of_the_standard():
    assert fletcher16(b"abcde").hex() == "c3ef"  # ossia's test of OpenTrackIO has this value too


@given(st.binary(max_size=600))
@settings(max_examples=50)
def test_the_checksum_of_anything_is_that_of_the_standard(data):
    assert fletcher16(data) == by_the_standard(data)


def test_a_packet_has_each_field_in_its_place():
    (packet,) = packets(b'{"a":1}', JSON, 0x1234, 1400)
    head = b"OTrk" + bytes.fromhex("00011234000000008007")
    assert packet == head + by_the_standard(head + b'{"a":1}') + b'{"a":1}'


@pytest.mark.parametrize("encoding", [JSON, CBOR])
@pytest.mark.parametrize("with_static", [True, False])
@pytest.mark.parametrize("focus", [None, 0.25])
def test_a_sample_is_valid_by_the_standards_schema(encoding, with_static, focus):
    made = sample(SOURCE, Moment(1718806554.25, 7, False), POSE, focus, "measured", with_static)
    data = encoded(made, encoding)
    read = json.loads(data) if encoding == JSON else cbor2.loads(data)
    JUDGE.validate(read)
    assert ("static" in read) is with_static
    assert read["timing"]["sampleTimestamp"] == {"seconds": 1718806554, "nanoseconds": 250000000}
    assert read["timing"]["synchronization"]["source"] == "ntp"


def test_pan_is_to_the_left_there_and_the_other_angles_as_here():
    (transform,) = sample(SOURCE, Moment(0.0, 0, False), POSE, None, "measured", False)["transforms"]
    assert transform["rotation"] == {"pan": -30.0, "tilt": -12.5, "roll": 1.25}
    assert transform["translation"] == {"x": 1.0, "y": 2.0, "z": 1.6}
    assert transform["id"] == "Camera"


def test_a_source_keeps_its_identity_and_each_sample_has_its_own():
    one, other = (sample(SOURCE, Moment(0.0, 0, False), POSE, None, "measured", False) for _ in range(2))
    assert one["sourceId"] == other["sourceId"] == identity("stage", "rig", 1).urn
    assert one["sampleId"] != other["sampleId"]
    assert identity("stage", "rig", 2) != identity("stage", "rig", 1) != identity("other", "rig", 1)


@pytest.mark.parametrize(("rate", "written"), [(50.0, (50, 1)), (23.976, (2997, 125)), (30000 / 1001, (30000, 1001))])
def test_a_rate_is_a_ratio(rate, written):
    made = sample(SOURCE._replace(rate=rate), Moment(0.0, 0, False), POSE, None, "measured", False)
    assert tuple(made["timing"]["sampleRate"].values()) == written


@pytest.mark.parametrize("encoding", [JSON, CBOR])
@pytest.mark.parametrize("room", [60, 333, 4000])
def test_a_sample_in_segments_comes_back_whole_over_the_end_of_the_numbers(encoding, room):
    data = encoded(sample(SOURCE, Moment(5.0, 1, True), POSE, 0.5, "measured", True), encoding)
    joined = Reassembly()
    found = [joined.add("a", parsed(each)) for each in packets(data, encoding, 65534, room)]
    assert found == [*[None] * (len(found) - 1), data]
    back = received(data, encoding)
    assert back.number == 1
    assert back.pose == pytest.approx(POSE)


def test_a_sample_with_a_segment_missing_is_dropped_and_the_next_one_is_whole():
    data = b"x" * 1000
    joined = Reassembly()
    segments = [parsed(each) for each in packets(data, JSON, 1, 300)]
    assert [joined.add("a", segments[place]) for place in (0, 1, 3)] == [None] * 3
    assert [joined.add("a", each) for each in segments][-1] == data


def test_segments_of_two_senders_do_not_mix():
    joined = Reassembly()
    ours, theirs = ([parsed(each) for each in packets(letter * 500, JSON, 1, 300)] for letter in (b"a", b"b"))
    found = [(joined.add("ours", one), joined.add("theirs", other)) for one, other in zip(ours, theirs, strict=True)]
    assert found[-1] == (b"a" * 500, b"b" * 500)


def test_what_is_no_packet_says_why():
    (packet,) = packets(b"{}", JSON, 1, 1400)
    for data, why in [
        (packet[:10], "has 10 bytes"),
        (b"X" + packet[1:], "OTrk"),
        (packet[:5] + b"\x03" + packet[6:], "encoding 3"),
        (packet + b" ", "has 3 bytes of a sample"),
        (packet[:-1] + b"]", "wrong checksum"),
    ]:
        with pytest.raises(PacketError, match=why):
            parsed(data)


def test_the_checksum_of_smptes_first_sender_is_taken_and_noticed():
    (packet,) = packets(b"{}", JSON, 1, 1400)
    for order in (1, -1):
        other = packet[:14] + fletcher16(packet[:14] + b"{}", 255)[::order] + b"{}"
        assert not parsed(other).by_the_book
    assert parsed(packet).by_the_book


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"[" * 100_000,
        b"[]",
        b"{}",
        b'{"transforms": []}',
        b'{"transforms": [3]}',
        b'{"transforms": [{"translation": {"x": 1, "y": 2}, "rotation": {"pan": 0, "tilt": 0, "roll": 0}}]}',
        b'{"transforms": [{"translation": {"x": NaN, "y": 2, "z": 3}, "rotation": {"pan": 0, "tilt": 0, "roll": 0}}]}',
        b'{"transforms": [{"translation": {"x": 1e99, "y": 2, "z": 3}, "rotation": {"pan": 0, "tilt": 0, "roll": 0}}]}',
        b'{"transforms": [{"translation": {"x": true, "y": 2, "z": 3}, "rotation": {"pan": 0, "tilt": 0, "roll": 0}}]}',
    ],
)
def test_what_is_no_sample_says_so(data):
    with pytest.raises(SampleError):
        received(data, JSON)
    with pytest.raises(SampleError):
        received(data, CBOR)


def test_the_camera_is_found_among_other_transforms():
    def transform(name: str, x: float) -> dict:
        return {"id": name, "translation": {"x": x, "y": 0, "z": 0}, "rotation": {"pan": 0, "tilt": 0, "roll": 0}}

    both = json.dumps({"transforms": [transform("Dolly", 1.0), transform("Camera", 2.0)]}).encode()
    assert received(both, JSON).pose.x == 2.0
