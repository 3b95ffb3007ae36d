"""`teleop decode hid` as people use it: a descriptor in a file of any kind, reports typed or piped."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import pytest
from hid_bench import DESCRIPTORS, KNOWN, label
from hypothesis import given
from hypothesis import strategies as st

from teleop.cli.codec import decode
from teleop.cli.codec.decode import InputError
from teleop.cli.codec.decode_hid import decode_reports, descriptor_bytes
from teleop.inputs.hid.descriptor.parser import parse_descriptor

STICK = "05010904a1018501093009311581257f750895028102c0"  # X and Y of 8 bits in report 1
KEYS = "05071904290815012505750895038100"


def record(usage: int, name: str, value: int) -> dict[str, Any]:
    return {
        "usage_page": 1,
        "usage": usage,
        "name": name,
        "value": value,
        "min": -127,
        "max": 127,
        "relative": False,
        "null": False,
    }


def run(descriptor: Path, *reports: str) -> None:
    decode.app(["hid", "--descriptor", str(descriptor), *reports], result_action="return_value")


@pytest.fixture
def stick(tmp_path: Path) -> Path:
    path = tmp_path / "stick"
    path.write_bytes(bytes.fromhex(STICK))
    return path


@pytest.mark.parametrize("known", KNOWN, ids=label)
@pytest.mark.parametrize("text", [False, True], ids=["bytes", "hexadecimal"])
def test_published_devices(
    known: dict[str, Any], text: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "descriptor"
    path.write_bytes(known["descriptor"].encode() if text else bytes.fromhex(known["descriptor"]))
    run(path, *(report["hex"] for report in known["reports"]))
    lines = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert len(lines) == len(known["reports"])
    renamed = {"logical_min": "min", "logical_max": "max"}
    for line, report in zip(lines, known["reports"], strict=True):
        assert {line["report_id"]} == {control["report_id"] for control in report["expected"]}
        assert [{**control, "name": None} for control in line["controls"]] == [
            {"name": None, **{renamed.get(key, key): value for key, value in control.items() if key != "report_id"}}
            for control in report["expected"]
        ]


def test_the_line_of_a_report(stick: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run(stick, "01 05 FB", "0x01,0x7f,0x81")
    printed = capsys.readouterr()
    first, second = printed.out.splitlines()
    assert first == json.dumps({"report_id": 1, "controls": [record(0x30, "X", 5), record(0x31, "Y", -5)]})
    assert json.loads(second) == {"report_id": 1, "controls": [record(0x30, "X", 127), record(0x31, "Y", -127)]}
    assert printed.err == ""


def test_an_array_has_the_number_of_the_report_too() -> None:
    (line,) = decode_reports(parse_descriptor(bytes.fromhex(KEYS)), ["020000"], pytest.fail)
    (control,) = json.loads(line)["controls"]
    assert (control["name"], control["value"], control["raw"]) == ("Key B", 1, 2)


def test_lines_of_standard_input_are_reports(
    stick: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(b"010102\n\n\xff\n0103 04\n"), encoding="utf-8"))
    run(stick)
    lines = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert [[control["value"] for control in line.get("controls", [])] for line in lines] == [[1, 2], [], [3, 4]]
    assert lines[1]["damage"].startswith("not hexadecimal")


def test_what_is_odd_is_told_once_and_beside_the_records(stick: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run(stick, "0105", "0106", "09ff", "01050607", "zz", "")
    printed = capsys.readouterr()
    lines = [json.loads(line) for line in printed.out.splitlines()]
    assert [list(line) for line in lines] == [["report_id", "controls"]] * 4 + [["damage", "bytes"]] * 2
    assert [[control["value"] for control in line["controls"]] for line in lines[:4]] == [[5], [6], [], [5, 6]]
    assert [line["damage"] for line in lines[4:]] == ["not hexadecimal: 'zz'", "an empty report: ''"]
    assert printed.err.splitlines() == [
        f"teleop: {stick}: report 1 has 2 bytes of 3: controls beyond are left out",
        f"teleop: {stick}: report 9 is not in the descriptor, which has inputs in: 1",
        f"teleop: {stick}: report 1 has 4 bytes, 3 by the descriptor: the rest is not read",
    ]


def test_a_truncated_descriptor_gives_what_can_be_read(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "cut"
    path.write_bytes(bytes.fromhex(STICK)[:-1] + b"\x26\x01")
    run(path, "010203")
    printed = capsys.readouterr()
    assert [control["value"] for control in json.loads(printed.out)["controls"]] == [2, 3]
    assert printed.err == f"teleop: {path}: byte 22: the descriptor ends inside this item\n"


@pytest.mark.parametrize(
    ("content", "data", "warning"),
    [
        (bytes.fromhex(STICK), STICK, ""),
        (STICK.encode(), STICK, ""),
        (b"\xef\xbb\xbf" + STICK.upper().encode() + b"\r\n", STICK, ""),
        (b"{\n\t0x05, 0x01, // Usage Page\n\t0x09, 0x04, /* 12 */ };", "05010904", ""),
        (b"# a pad\n05 01\n", "0501", ""),
        (b"05 01 9", "0501", "the hexadecimal ends inside a byte"),
        (b"hello", b"hello".hex(), "text, but not hexadecimal: taken as the bytes of a descriptor"),
        (b"", "", ""),
    ],
)
def test_descriptors_as_people_have_them(content: bytes, data: str, warning: str) -> None:
    assert descriptor_bytes(content) == (bytes.fromhex(data), warning)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No such file or directory"):
        run(tmp_path / "absent", "00")


@given(st.binary(max_size=60) | st.text(max_size=60).map(str.encode), st.lists(st.text(max_size=20)))
def test_decoding_never_raises(content: bytes, lines: list[str]) -> None:
    descriptor = parse_descriptor(descriptor_bytes(content)[0])
    for line in decode_reports(descriptor, lines, lambda _: None):
        assert {"controls", "damage"} & set(json.loads(line))


@given(st.sampled_from(DESCRIPTORS), st.lists(st.binary(max_size=70)))
def test_a_line_for_each_report(descriptor: bytes, reports: list[bytes]) -> None:
    lines = decode_reports(parse_descriptor(descriptor), [report.hex() for report in reports], lambda _: None)
    assert len(list(lines)) == len(reports)
