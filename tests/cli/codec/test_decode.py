"""`teleop decode` and `teleop encode` are each other's inverse, on published frames and on whatever else arrives."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.cli.codec import decode, encode
from teleop.cli.codec.decode import R_SDK_IDS, InputError, decode_candump, decode_hex
from teleop.cli.codec.encode import encode_lines
from teleop.dji.frame import Frame, pieces
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.gimbal.session import Session
from teleop.dji.json_record import RecordError
from teleop.dji.message import Result, ReturnCode

FRAMES = [
    vector["hex"] for vector in json.loads((Path(__file__).parents[2] / "data" / "r-sdk.json").read_text())["vectors"]
]
SAMPLE = FRAMES[0]
SAMPLE_LINE = (
    '{"message": "gimbal.position", "reply": false, "cmd_type": 3, "sequence": 4386, "fields": {"yaw": 3.2, '
    '"roll": 4.8, "pitch": 6.4, "absolute": true, "yaw_ignored": false, "roll_ignored": false, '
    '"pitch_ignored": false, "time_for_action": 2.0}}'
)


def decoded(*lines: str) -> list[dict[str, Any]]:
    return [json.loads(line) for line in decode_hex(lines, R_SDK)]


def candump(*lines: str) -> list[dict[str, Any]]:
    return [json.loads(line) for line in decode_candump(lines, R_SDK, R_SDK_IDS)]


def logged(data: bytes, can_id: str, seconds: float = 1.0, bus: str = "can0") -> list[str]:
    return [f"({seconds:.6f}) {bus} {can_id}#{piece.hex().upper()}\n" for piece in pieces(data)]


def test_published_frames_come_out_as_they_went_in() -> None:
    lines = list(decode_hex(FRAMES, R_SDK))
    assert len(lines) == len(FRAMES)
    assert list(encode_lines(lines, R_SDK)) == FRAMES


def test_the_line_of_the_documents_sample() -> None:
    assert list(decode_hex([SAMPLE], R_SDK)) == [SAMPLE_LINE]


@pytest.mark.parametrize("separator", ["", " ", ":", ", ", "\t"])
def test_hexadecimal_as_people_paste_it(separator: str) -> None:
    pairs = [SAMPLE[at : at + 2].upper() for at in range(0, len(SAMPLE), 2)]
    assert decoded(separator.join(pairs) + "\n") == [json.loads(SAMPLE_LINE)]
    assert decoded(" ".join(f"0x{pair}" for pair in pairs)) == [json.loads(SAMPLE_LINE)]


def test_pieces_on_lines_of_their_own_are_one_stream() -> None:
    cut = list(encode_lines([SAMPLE_LINE, SAMPLE_LINE], R_SDK, can=True))
    assert cut[:4] == ["aa1a000300000000", "2211a2420e002000", "3000400001147b40", "97be"]
    assert decoded(*cut) == [json.loads(SAMPLE_LINE)] * 2


def test_frames_are_told_as_soon_as_they_are_whole() -> None:
    def endless() -> Iterator[str]:
        yield SAMPLE
        raise AssertionError("read on before telling what is known")

    assert next(decode_hex(endless(), R_SDK)) == SAMPLE_LINE


def test_damage_is_a_line_and_what_is_behind_it_survives() -> None:
    found = decoded("no hex", SAMPLE[:20], "", SAMPLE, "aa")
    assert found == [
        {"damage": "not hexadecimal: 'no hex'", "bytes": ""},
        {"damage": "header CRC-16 is wrong", "bytes": SAMPLE[:20]},
        json.loads(SAMPLE_LINE),
        {"damage": "incomplete frame", "bytes": "aa"},
    ]


@given(st.lists(st.binary(max_size=30) | st.sampled_from(FRAMES).map(bytes.fromhex), max_size=8))
def test_encoding_what_was_decoded_gives_every_byte_back(parts: list[bytes]) -> None:
    lines = decode_hex([part.hex() for part in parts], R_SDK)
    assert "".join(encode_lines(lines, R_SDK)) == b"".join(parts).hex()


@given(st.lists(st.text(max_size=40)))
def test_decoding_never_raises(lines: list[str]) -> None:
    for line in [*decode_hex(lines, R_SDK), *decode_candump(lines, R_SDK, R_SDK_IDS)]:
        assert "message" in json.loads(line) or "damage" in json.loads(line)


def test_both_directions_of_a_candump_log_are_streams_of_their_own() -> None:
    host, device = Session(), Session()
    asked = [host.command(gimbal.Angles()), host.command(gimbal.Position(1, 2, 3))]
    replies = [gimbal.AnglesReply(ReturnCode.OK, gimbal.AngleKind.ATTITUDE, 1.0, 2.0, 3.0), Result()]
    out = [line for frame in asked for line in logged(frame, "223")]
    back = [
        line
        for received, reply in zip(device.receive(b"".join(asked), 0.0), replies, strict=True)
        for line in logged(device.reply(received.frame, reply, bare=True), "222")
    ]
    foreign = ["(1.0) can0 530#0102030405060708\n", "(1.0) can0 00000222#AA\n", "\n"]
    mixed = [line for lines in zip_longest(foreign, out, ["", "", *back], fillvalue="") for line in lines]
    found = candump(*mixed)
    assert [record["message"] for record in found if not record["reply"]] == ["gimbal.angles", "gimbal.position"]
    assert [record["message"] for record in found if record.get("bare")] == ["gimbal.angles", "gimbal.position"]
    assert len(found) == 4


def test_buses_are_kept_apart_and_a_gap_ends_a_frame() -> None:
    sample = bytes.fromhex(SAMPLE)
    first, second = logged(sample, "223", bus="can0"), logged(sample, "223", bus="can1")
    assert (
        candump(*(line for pair in zip(first, second, strict=True) for line in pair)) == [json.loads(SAMPLE_LINE)] * 2
    )
    late = logged(sample, "223", seconds=1.2)
    assert [next(iter(record)) for record in candump(*first[:2], *late)] == ["damage", "message"]


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("can0 223#AA", "not a line of candump -L"),
        ("(1.0) can0 223#R", "not a data frame"),
        ("(1.0) can0 223##1AA", "not a data frame"),
    ],
)
def test_lines_that_are_no_can_frame_are_damage(line: str, reason: str) -> None:
    assert candump(line) == [{"damage": f"{reason}: {line!r}", "bytes": ""}]


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("{", "line 2: not JSON: Expecting property name enclosed in double quotes at column 2"),
        ("[]", "line 2: not a JSON object"),
        ('{"message": "gimbal.position"}', "line 2: 'reply' is missing"),
        (SAMPLE_LINE.replace("3.2", "1e9"), "line 2: gimbal.position: yaw 1e+09 does not fit its 16 bits"),
    ],
)
def test_a_line_that_cannot_be_encoded_is_named(line: str, error: str) -> None:
    lines = encode_lines([SAMPLE_LINE, line], R_SDK)
    assert next(lines) == SAMPLE
    with pytest.raises(RecordError) as raised:
        next(lines)
    assert str(raised.value) == error


def run(app: Any, *arguments: str) -> None:
    app(["r-sdk", *arguments], result_action="return_value")


def test_the_commands_read_arguments(capsys: pytest.CaptureFixture[str]) -> None:
    run(decode.app, SAMPLE[:16], SAMPLE[16:])
    assert capsys.readouterr().out == SAMPLE_LINE + "\n"
    run(encode.app, SAMPLE_LINE)
    assert capsys.readouterr().out == SAMPLE + "\n"
    run(encode.app, SAMPLE_LINE, "--can")
    assert capsys.readouterr().out.split() == [piece.hex() for piece in pieces(bytes.fromhex(SAMPLE))]


def test_the_commands_read_standard_input(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO("".join(logged(bytes.fromhex(SAMPLE), "222"))))
    run(decode.app, "--candump")
    printed = capsys.readouterr().out
    assert printed == SAMPLE_LINE + "\n"
    monkeypatch.setattr("sys.stdin", io.StringIO(printed))
    run(encode.app)
    assert capsys.readouterr().out == SAMPLE + "\n"


def test_a_candump_log_may_be_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = tmp_path / "candump.log"
    log.write_text("".join(logged(Frame(b"\x0e\x04\x01", 3).encode(), "223")))
    run(decode.app, "--candump", str(log))
    assert json.loads(capsys.readouterr().out)["message"] == "gimbal.limits"
    with pytest.raises(InputError, match="No such file"):
        run(decode.app, "--candump", str(tmp_path / "absent.log"))
