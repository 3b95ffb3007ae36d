"""Frames against published ones, against checks written bit by bit, and against every way to damage a stream."""

from __future__ import annotations

import json
import math
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.dji.frame import Damage, Frame, FrameError, FrameReader, pieces

DATA = Path(__file__).parents[1] / "data"
PUBLISHED = [
    (protocol, vector["hex"])
    for protocol in ("r-sdk", "onboard")
    for vector in json.loads((DATA / f"{protocol}.json").read_text())["vectors"]
]
SAMPLE = bytes.fromhex("AA 1A 00 03 00 00 00 00 22 11 A2 42 0E 00 20 00 30 00 40 00 01 14 7B 40 97 BE")

frames = st.builds(
    Frame,
    data=st.binary(max_size=60) | st.binary(max_size=1007) | st.lists(st.just(0xAA), max_size=40).map(bytes),
    cmd_type=st.integers(0, 255),
    sequence=st.integers(0, 0xFFFF),
    encryption=st.integers(0, 255),
    reserved=st.binary(min_size=3, max_size=3),
    version=st.integers(0, 63),
)


def bitwise(data: bytes, register: int, polynomial: int) -> int:
    for byte in data:
        register ^= byte
        for _ in range(8):
            register = register >> 1 ^ polynomial if register & 1 else register >> 1
    return register


def read(*parts: bytes) -> list[Frame | Damage]:
    reader = FrameReader()
    found = [item for part in parts for item in reader.feed(part, 0.0)]
    return found + reader.flush(math.inf)


def wire(found: list[Frame | Damage]) -> bytes:
    return b"".join(item.encode() if isinstance(item, Frame) else item.data for item in found)


@pytest.mark.parametrize(("protocol", "text"), PUBLISHED)
def test_published_frames_decode_and_encode_again(protocol: str, text: str) -> None:
    (frame,) = read(bytes.fromhex(text))
    assert isinstance(frame, Frame), protocol
    assert frame.encode().hex() == text


def test_the_documents_sample() -> None:
    expected = Frame(bytes.fromhex("0E00200030004000 0114"), cmd_type=0x03, sequence=0x1122)
    assert read(SAMPLE) == [expected]
    assert expected.encode() == SAMPLE


def test_every_header_field_is_read_from_its_place() -> None:
    vectors = json.loads((DATA / "onboard.json").read_text())["vectors"]
    (encrypted,) = (vector for vector in vectors if vector["name"] == "vrc_enable_backtoreal_enc")
    (frame,) = read(bytes.fromhex(encrypted["hex"]))
    assert isinstance(frame, Frame)
    assert (frame.sequence, frame.encryption >> 5, frame.encryption & 0x1F) == (258, 1, encrypted["pad"])
    assert frame.is_encrypted
    (acknowledgement,) = read(bytes.fromhex(next(v["hex"] for v in vectors if v["name"] == "header_only_ack")))
    assert isinstance(acknowledgement, Frame)
    assert acknowledgement.is_reply
    assert acknowledgement.data == b""


@pytest.mark.parametrize(
    ("cmd_type", "wanted"), [(0x00, False), (0x01, False), (0x02, True), (0x1F, True), (0x23, False)]
)
def test_whether_a_reply_is_wanted(cmd_type: int, wanted: bool) -> None:
    assert Frame(b"", cmd_type).wants_reply is wanted


@given(frames)
def test_checks_are_those_of_the_document(frame: Frame) -> None:
    encoded = frame.encode()
    assert int.from_bytes(encoded[10:12], "little") == bitwise(encoded[:10], 0x3AA3, 0xA001)
    if frame.data:
        assert int.from_bytes(encoded[-4:], "little") == bitwise(encoded[:-4], 0x3AA3, 0xEDB88320)


@given(st.lists(frames, max_size=5), st.lists(st.integers(0, 3000)))
def test_frames_come_back_however_the_stream_is_cut(sent: list[Frame], cuts: list[int]) -> None:
    stream = b"".join(frame.encode() for frame in sent)
    bounds = [0, *sorted(cut % (len(stream) + 1) for cut in cuts), len(stream)]
    assert read(*(stream[start:end] for start, end in pairwise(bounds))) == sent


@given(frames)
def test_one_byte_at_a_time(frame: Frame) -> None:
    assert read(*(bytes((byte,)) for byte in frame.encode())) == [frame]


starts = st.sampled_from(
    [b"\xaa", b"\xaa\xff\x03", SAMPLE[:11], SAMPLE[:12], SAMPLE[:-1], Frame(bytes(1007)).encode()[:12]]
)


@st.composite
def harmed(draw: st.DrawFn) -> bytes:
    """A frame of which some bytes, at least one, were lost or replaced by others."""
    encoded = draw(frames).encode()
    start = draw(st.integers(0, len(encoded) - 1))
    end = draw(st.integers(start + 1, len(encoded)))
    return encoded[:start] + draw(st.binary(max_size=3).filter(encoded[start:end].__ne__)) + encoded[end:]


junk = st.lists(st.binary(max_size=30) | starts | harmed(), max_size=4).map(b"".join)


@given(st.lists(junk | frames.map(Frame.encode), max_size=8), st.integers(1, 64))
def test_nothing_raises_and_every_byte_is_accounted_for(parts: list[bytes], size: int) -> None:
    stream = b"".join(parts)
    found = read(*(stream[at : at + size] for at in range(0, len(stream), size)))
    assert wire(found) == stream


@given(st.lists(st.tuples(junk, frames), max_size=5), junk)
def test_good_frames_between_damage_survive(parts: list[tuple[bytes, Frame]], last: bytes) -> None:
    stream = b"".join(damage + frame.encode() for damage, frame in parts) + last
    found = iter(read(stream))
    assert all(frame in found for _, frame in parts)


@given(frames, frames, st.data())
def test_a_frame_behind_a_truncated_one_survives(lost: Frame, good: Frame, data: st.DataObject) -> None:
    encoded = lost.encode()
    kept = data.draw(st.integers(1, len(encoded) - 1))
    found = read(encoded[:kept], good.encode())
    assert found[-1] == good
    assert wire(found[:-1]) == encoded[:kept]


@pytest.mark.parametrize("shared", [1, 2])
def test_a_frame_survives_one_that_lost_the_very_bytes_it_begins_with(shared: int) -> None:
    good = read(SAMPLE)[0]
    ends_alike = (Frame(b"\x0e\x12", sequence=number % 0x10000, cmd_type=number >> 16) for number in range(1 << 20))
    cut = next(frame for frame in ends_alike if frame.encode().endswith(SAMPLE[:shared]))
    stream = cut.encode()[:-shared] + SAMPLE
    assert read(stream) == [cut, good]
    assert read(*(bytes((byte,)) for byte in stream), SAMPLE) == [cut, good, good]
    assert read(cut.encode()) == [cut]
    assert read(cut.encode() + b"\x01") == [cut, Damage("no start byte", b"\x01")]


@given(frames, st.data())
def test_a_flipped_bit_is_damage(frame: Frame, data: st.DataObject) -> None:
    encoded = bytearray(frame.encode())
    at = data.draw(st.integers(0, 8 * len(encoded) - 1))
    encoded[at // 8] ^= 1 << at % 8
    assert frame not in read(bytes(encoded))


@pytest.mark.parametrize(
    ("stream", "reason"),
    [
        (b"\x01\x02\x03", "no start byte"),
        (SAMPLE[:5] + b"\x99" + SAMPLE[6:], "header CRC-16 is wrong"),
        (SAMPLE[:15] + b"\x99" + SAMPLE[16:], "frame CRC-32 is wrong"),
        (SAMPLE[:20], "incomplete frame"),
    ],
)
def test_damage_says_why(stream: bytes, reason: str) -> None:
    assert read(stream) == [Damage(reason, stream)]


@pytest.mark.parametrize("size", [0, 11, 13, 16])
def test_an_impossible_length_is_damage_even_with_a_good_check(size: int) -> None:
    header = bytes((0xAA, size, 0, 0, 0, 0, 0, 0, 0, 0))
    stream = header + bitwise(header, 0x3AA3, 0xA001).to_bytes(2, "little")
    assert read(stream + SAMPLE) == [Damage(f"length {size} is impossible", stream), read(SAMPLE)[0]]


def test_a_partial_frame_is_given_up_after_a_gap() -> None:
    patient, gone = FrameReader(), FrameReader()
    assert patient.feed(SAMPLE[:13], 5.0) == gone.feed(SAMPLE[:13], 5.0) == []
    assert patient.feed(SAMPLE[13:], 5.1) == read(SAMPLE)
    assert gone.feed(SAMPLE[13:], 5.11)[0] == Damage("incomplete frame", SAMPLE[:13])
    assert gone.feed(SAMPLE, 5.12)[-1] == read(SAMPLE)[0]


def test_a_good_frame_inside_the_length_that_a_truncated_one_claims_is_found_after_the_gap() -> None:
    reader = FrameReader()
    cut = Frame(bytes(1000)).encode()[:14]
    assert reader.feed(cut + SAMPLE, 0.0) == []
    assert reader.flush(0.1) == []
    assert reader.flush(0.2) == [Damage("incomplete frame", cut), read(SAMPLE)[0]]


@pytest.mark.parametrize(
    "frame",
    [
        Frame(bytes(1008)),
        Frame(b"", cmd_type=256),
        Frame(b"", sequence=0x10000),
        Frame(b"", sequence=-1),
        Frame(b"", encryption=256),
        Frame(b"", reserved=b"\0\0"),
        Frame(b"", version=64),
        Frame(b"", version=-1),
    ],
)
def test_what_does_not_fit_a_frame_is_refused(frame: Frame) -> None:
    with pytest.raises(FrameError, match=r"^(a frame of 1024 bytes is too long|frame fields do not fit)"):
        frame.encode()


@given(st.binary(min_size=1, max_size=100))
def test_pieces_are_eight_bytes_and_the_last_one_what_is_left(frame: bytes) -> None:
    cut = pieces(frame)
    assert b"".join(cut) == frame
    assert all(len(piece) == 8 for piece in cut[:-1])
    assert 1 <= len(cut[-1]) <= 8


@given(st.lists(frames, min_size=1, max_size=4), st.sampled_from([0x00, 0xAA, 0xFF, 0x55]), st.booleans())
def test_frames_whose_last_can_frame_is_filled_up_are_no_damage(sent: list[Frame], filler: int, empty: bool) -> None:
    """Whatever it is filled with, the start byte included; and CAN frames without data may lie between."""
    reader, found = FrameReader(in_pieces=True), []
    for frame in sent:
        for piece in pieces(frame.encode()):
            found += reader.feed(piece.ljust(8, bytes((filler,))), 0.0)
            found += reader.feed(b"", 0.0) if empty else []
    found += reader.flush(math.inf)
    assert [item for item in found if isinstance(item, Frame)] == sent
    assert all(item.is_padding for item in found if isinstance(item, Damage))
    assert wire(found) == b"".join(
        piece.ljust(8, bytes((filler,))) for frame in sent for piece in pieces(frame.encode())
    )


@given(st.lists(frames, min_size=1, max_size=4))
def test_frames_in_pieces_that_are_not_filled_up_have_no_padding(sent: list[Frame]) -> None:
    reader = FrameReader(in_pieces=True)
    found = [item for frame in sent for piece in pieces(frame.encode()) for item in reader.feed(piece, 0.0)]
    together = FrameReader(in_pieces=True).feed(b"".join(frame.encode() for frame in sent), 0.0)
    assert found == together == sent


@pytest.mark.parametrize(
    ("behind", "padding", "damage"),
    [(1, b"", bytes(1)), (5, b"", bytes(5)), (6, bytes(6), b""), (8, bytes(6), bytes(2))],
)
def test_only_what_fills_the_last_piece_is_padding(behind: int, padding: bytes, damage: bytes) -> None:
    """The sample ends with a piece of 2 bytes."""
    _, *rest = FrameReader(in_pieces=True).feed(SAMPLE + bytes(behind), 0.0)
    runs = [item for item in rest if isinstance(item, Damage)]
    assert b"".join(run.data for run in runs if run.is_padding) == padding
    assert b"".join(run.data for run in runs if not run.is_padding) == damage
