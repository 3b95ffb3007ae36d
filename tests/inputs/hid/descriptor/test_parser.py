"""Report descriptors: the published ones, every trap of HID 1.11 on its own, and damage of every kind."""

from __future__ import annotations

from typing import Any

import pytest
from hid_bench import DESCRIPTORS, KNOWN, as_expected, label, values
from hypothesis import given
from hypothesis import strategies as st

from teleop.inputs.hid.descriptor.identity import MAX_NAMES
from teleop.inputs.hid.descriptor.parser import (
    MAX_FIELD,
    MAX_FIELDS,
    MAX_REPORT,
    MAX_REPORT_FIELDS,
    MAX_WARNINGS,
    parse_descriptor,
)
from teleop.inputs.hid.descriptor.report import read_report

JOYSTICK = "05010904a101"
BYTE = "150026ff00750895"  # a field of 8 bits, 0..255; its count comes next


@pytest.mark.parametrize("known", KNOWN, ids=label)
def test_published_reports_hold_what_is_expected(known: dict[str, Any]) -> None:
    descriptor = parse_descriptor(bytes.fromhex(known["descriptor"]))
    for report in known["reports"]:
        found = [as_expected(control) for control in read_report(descriptor, bytes.fromhex(report["hex"]))]
        assert found == report["expected"]


@pytest.mark.parametrize("known", KNOWN, ids=label)
def test_published_reports_are_as_long_as_the_descriptor_says(known: dict[str, Any]) -> None:
    descriptor = parse_descriptor(bytes.fromhex(known["descriptor"]))
    for report in known["reports"]:
        data = bytes.fromhex(report["hex"])
        assert descriptor.lengths[data[0] if descriptor.numbered else 0] == len(data)


def test_only_what_is_odd_about_a_published_descriptor_is_warned_of() -> None:
    found = {known["name"]: parse_descriptor(bytes.fromhex(known["descriptor"])).warnings for known in KNOWN}
    assert {name: warnings for name, warnings in found.items() if warnings} == {
        "8BitDo SN30 Pro+ (Windows mode, poses as Xbox)": ("byte 306: a reserved main item; skipped",),
        "Atari VCS Classic Controller (stick with dial)": ("byte 255: the descriptor ends inside this item",),
    }


@pytest.mark.parametrize(
    ("descriptor", "report", "controls"),
    [
        pytest.param("0930 81 02".join((JOYSTICK + BYTE + "01", "c0")), "07", [("X", 7)], id="plain"),
        pytest.param(f"{JOYSTICK}{BYTE}02 0930 8102", "0708", [("X", 7), ("X 2", 8)], id="the last usage is repeated"),
        pytest.param(f"{JOYSTICK}{BYTE}01 0930 0931 8102", "07", [("X", 7)], id="more usages than fields"),
        pytest.param(f"{JOYSTICK}{BYTE}01 8102 0930 8102", "0708", [("X", 8)], id="no usage: left out, its bits count"),
        pytest.param(f"{JOYSTICK}{BYTE}01 0931 8103 0930 8102", "0708", [("X", 8)], id="a constant with a usage"),
        pytest.param(f"{JOYSTICK}{BYTE}00 0931 8102 9501 0930 8102", "07", [("X", 7)], id="report count 0"),
        pytest.param(
            f"{JOYSTICK}{BYTE}01 7500 0931 8102 7508 0930 8102", "07", [("X", 7)], id="report size 0 holds nothing"
        ),
        pytest.param(f"{JOYSTICK}{BYTE}01 0930 a100 8102 0931 8102", "0708", [("Y", 8)], id="a collection ends locals"),
        pytest.param(f"{JOYSTICK}{BYTE}01 0930 9102 8102 0931 8102", "0708", [("Y", 8)], id="an output ends locals"),
        pytest.param(f"{JOYSTICK}{BYTE}01 0930 b102 0931 8102", "07", [("Y", 7)], id="features have other reports"),
        pytest.param(f"{BYTE}01 0501 a101 0930 8102 c0 0502 a101 09c5 8102 c0", "0708", [("X", 7), ("Brake", 8)], id="globals outlive collections"),  # noqa: E501  # a row of a table
        pytest.param(f"05 09 {BYTE}01 0b 30000100 8102", "07", [("X", 7)], id="a usage with its page"),
        pytest.param(f"0509 {BYTE}03 1b30000100 2b32000100 8102", "070809", [("X", 7), ("Y", 8), ("Z", 9)], id="a range with its page"),  # noqa: E501
        pytest.param(f"0501 {BYTE}03 1930 2931 0935 8102", "070809", [("X", 7), ("Y", 8), ("Rz", 9)], id="a range, then a usage"),  # noqa: E501
        pytest.param(f"0501 {BYTE}03 0935 2931 1930 8102", "070809", [("Rz", 7), ("X", 8), ("Y", 9)], id="the maximum first"),  # noqa: E501
        pytest.param(f"0501 {BYTE}03 1930 2931 8102", "070809", [("X", 7), ("Y", 8), ("Y 2", 9)], id="a range too short"),  # noqa: E501
        pytest.param(f"0509 {BYTE}02 2903 8102", "0708", [("Button 0x9:0x0", 7), ("Button 1", 8)], id="a maximum only"),
        pytest.param(f"0501 {BYTE}01 1930 29ff 8102", "07", [("X", 7)], id="a range too long"),
        pytest.param(f"0501 {BYTE}02 0930 0502 09c5 8102", "0708", [("X", 7), ("Brake", 8)], id="pages between usages"),
        pytest.param(f"0501 {BYTE}02 0901 0902 0509 8102", "0708", [("Button 1", 7), ("Button 2", 8)], id="the page last"),  # noqa: E501
        pytest.param(f"0501 {BYTE}02 0b31000100 0902 0509 8102", "0708", [("Y", 7), ("Button 2", 8)], id="the page last leaves extended usages"),  # noqa: E501
        pytest.param(f"0501 {BYTE}02 0930 0509 0901 0509 8102", "0708", [("X", 7), ("Button 1", 8)], id="the page again"),  # noqa: E501
        pytest.param(f"0501 {BYTE}02 a901 0930 0931 0932 a900 0933 8102", "0708", [("X", 7), ("Rx", 8)], id="delimiters"),  # noqa: E501
        pytest.param(f"0501 {BYTE}02 a901 1930 2931 a900 8102", "0708", [("X", 7), ("Y", 8)], id="a range in delimiters"),  # noqa: E501
        pytest.param(f"0501 {BYTE}02 0930 3901 4902 5903 7904 8905 9906 0931 8102", "0708", [("X", 7), ("Y", 8)], id="designators and strings"),  # noqa: E501
        pytest.param(f"0501 {BYTE}01 3500 46ff7f 5513 6514 0930 8102", "07", [("X", 7)], id="units and physical range"),
        pytest.param(f"0501 {BYTE}01 fe00 00 fe020f aaaa 0930 8102", "07", [("X", 7)], id="long items"),
        pytest.param(f"0501 {BYTE}01 0d 3d 0930 8102", "07", [("X", 7)], id="the reserved type"),
        pytest.param(f"0501 {BYTE}01 0930 820201", "07", [("X", 7)], id="buffered bytes"),
        pytest.param(f"0501 {BYTE}01 0930 813a", "07", [("X", 7)], id="wrap, nonlinear, no preferred state"),
        pytest.param("0501 14 257f 7508 9501 0930 8102", "07", [("X", 7)], id="an item without data is 0"),
        pytest.param(f"0501 {BYTE}01 a4 7510 0930 b4 8102 0931 8102", "0708", [("X", 7), ("Y", 8)], id="Pop keeps usages"),  # noqa: E501
    ],
)  # fmt: skip
def test_the_rules_of_the_document(descriptor: str, report: str, controls: list[tuple[str, int]]) -> None:
    assert values(descriptor, report) == controls


@pytest.mark.parametrize(
    ("limits", "value", "expected"),
    [
        ("1581 257f", 0xFF, (-1, -127, 127)),
        ("1500 25ff", 0xFF, (255, 0, 255)),
        ("1500 2580", 0xFF, (255, 0, 128)),
        ("15ff 2501", 0x80, (-128, -1, 1)),
        ("168000 26ff00", 0xFF, (255, 128, 255)),
        ("1701000080 27ffffff7f", 0xFF, (-1, -2147483647, 2147483647)),
        ("1500 27ffffffff", 0xFF, (255, 0, 4294967295)),
        ("", 0xFF, (255, 0, 0)),
    ],
)
def test_a_range_is_signed_when_its_minimum_is_negative(limits: str, value: int, expected: tuple[int, ...]) -> None:
    parsed = parse_descriptor(bytes.fromhex(f"0501 {limits} 7508 9501 0930 8102"))
    (control,) = read_report(parsed, bytes((value,)))
    assert (control.value, control.minimum, control.maximum) == expected


def test_a_report_is_filled_by_every_collection_that_names_it() -> None:
    stick = "0501 0904 a101 8501 0930 8102 c0"
    buttons = "0509 a101 8502 0902 8102 8501 0901 8102 c0"
    assert values(f"{BYTE}01 {stick} {buttons}", "010708") == [("X", 7), ("Button 1", 8)]
    assert values(f"{BYTE}01 {stick} {buttons}", "0209") == [("Button 2", 9)]


def test_flags_of_a_field() -> None:
    parsed = parse_descriptor(bytes.fromhex(f"0501 {BYTE}01 0930 8106 0939 8142 0938 8102"))
    assert [(field.relative, field.has_null) for field in parsed.fields] == [
        (True, False),
        (False, True),
        (False, False),
    ]


@pytest.mark.parametrize(
    ("descriptor", "warning"),
    [
        ("", "no input has a usage: nothing can be read from its reports"),
        ("b4", "byte 0: a Pop without a Push; skipped"),
        ("0501 c0", "byte 2: a collection ends that did not begin"),
        (JOYSTICK, "collections left open: 1; the end may be missing"),
        ("0501 0930", "the last items set up an input that does not come: the end may be missing"),
        (JOYSTICK + "26ff", "byte 6: the descriptor ends inside this item"),
        ("fe", "byte 0: the descriptor ends inside this item"),
        ("fe0400aabb", "byte 0: the descriptor ends inside this item"),
        ("8500", "byte 0: report id 0: must be 1..255"),
        ("860001", "byte 0: report id 256: must be 1..255"),
        (f"0501{BYTE}01 0930 8102 8501", "inputs come before the first report id and are in no report of this device"),
        ("1905 2901 8102", "byte 2: usages from a minimum to a maximum that is below it; left out"),
        ("1b01000900 2b02000100 8102", "byte 5: usages from a minimum to a maximum that is below it; left out"),
        ("1905 8102", "byte 2: a usage minimum without a maximum; left out"),
        ("2905 8102", "byte 2: a usage maximum without a minimum; taken from 0, as Linux does"),
        ("a901 a901 8102", "byte 2: a delimiter inside a delimiter"),
        ("a900 8102", "byte 0: a delimiter closed that was not open"),
        ("1505 2501 7508 9501 0501 0930 8102", "byte 12: a logical maximum of 1 is below the minimum of 5"),
        ("0d00", "byte 0: an item of the reserved type; skipped"),
        ("c500", "byte 0: a reserved global item; skipped"),
        ("6900", "byte 0: a reserved local item; skipped"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(descriptor: str, warning: str) -> None:
    assert warning in parse_descriptor(bytes.fromhex(descriptor)).warnings


def test_a_thing_is_told_once_and_there_is_an_end_to_it() -> None:
    pops = parse_descriptor(b"\xb4" * 1000 + b"\x81\x02").warnings
    assert pops == (
        "byte 0: a Pop without a Push; skipped",
        "no input has a usage: nothing can be read from its reports",
    )
    many = parse_descriptor(b"".join(b"\x86" + number.to_bytes(2, "little") for number in range(256, 1256))).warnings
    assert many[:MAX_WARNINGS][-1] == "byte 57: report id 275: must be 1..255"
    assert many[MAX_WARNINGS] == "980 more of this kind"


@pytest.mark.parametrize(
    ("descriptor", "fields", "warning"),
    [
        (
            "0509 0901 7501 97ffffffff 8102",
            MAX_REPORT_FIELDS,
            "byte 11: 4294967295 inputs of 1 bits: only the first 8192 are read",
        ),
        ("0509 0901 7501 97ffffffff 8100", 1, "byte 11: 4294967295 inputs of 1 bits: only the first 8192 are read"),
        ("0509 0901 760010 97ffffffff 8102", 32, "byte 12: 4294967295 inputs of 4096 bits: only the first 32 are read"),
        ("0501 0930 77ffffffff 9501 8102", 0, "byte 11: inputs of 4294967295 bits: more than 4096 are not read"),
        ("0501 77ffffffff 97ffffffff 8101", 0, "no input has a usage: nothing can be read from its reports"),
    ],
)
def test_sizes_and_counts_that_no_device_has(descriptor: str, fields: int, warning: str) -> None:
    parsed = parse_descriptor(bytes.fromhex(descriptor))
    assert len(parsed.fields) == fields
    assert warning in parsed.warnings
    assert sum(field.count for field in parsed.fields) <= MAX_REPORT_FIELDS
    read_report(parsed, bytes(2 * MAX_REPORT))


def test_a_descriptor_full_of_the_worst_is_read_within_limits() -> None:
    buttons = bytes.fromhex("0509 7501 97ffffffff")
    reports = b"".join(bytes((0x85, number)) + bytes.fromhex("0901 8102") for number in range(256))
    parsed = parse_descriptor(buttons + reports)
    assert len(parsed.fields) == MAX_FIELDS
    assert max(parsed.lengths.values()) == MAX_REPORT + 1
    endless = parse_descriptor(bytes.fromhex("1901 2aff7f") * 10_000 + bytes.fromhex("7501 9508 8102"))
    assert len(endless.fields) == 8
    arrays = parse_descriptor(bytes.fromhex("0507 150026ff03 7508 9501") + bytes.fromhex("19002aff03 8100") * 8_000)
    assert sum(len(field.usages or ()) for field in arrays.fields) <= MAX_NAMES
    long = parse_descriptor(bytes.fromhex("a4") * 1_000_000)
    assert long.warnings[0] == "byte 65535: longer than a descriptor can be; the rest is not read"


@pytest.mark.parametrize("known", KNOWN, ids=label)
def test_a_descriptor_cut_short_gives_the_beginning_of_what_it_would(known: dict[str, Any]) -> None:
    data = bytes.fromhex(known["descriptor"])
    whole = parse_descriptor(data)
    places = {(field.report_id, field.bit, field.usage_page, field.usage) for field in whole.fields}
    fields = 0
    for end in range(len(data)):
        cut = parse_descriptor(data[:end])
        assert cut.warnings or (end and data[end - 1] == 0xC0)  # the end of an outermost collection may be the end
        assert len(cut.fields) >= fields
        assert {(field.report_id, field.bit, field.usage_page, field.usage) for field in cut.fields} <= places
        fields = len(cut.fields)
        for report in known["reports"]:
            read_report(cut, bytes.fromhex(report["hex"]))


def descriptors() -> st.SearchStrategy[bytes]:
    """Anything, items of any tag, and published descriptors with bytes changed."""
    items = st.tuples(st.integers(0, 255), st.binary(min_size=4, max_size=4)).map(
        lambda item: bytes((item[0],)) + item[1][: (0, 1, 2, 4)[item[0] & 3]]
    )
    changed = st.tuples(st.sampled_from(DESCRIPTORS), st.integers(0, 600), st.binary(max_size=6), st.integers(0, 6))
    return st.one_of(
        st.binary(max_size=400),
        st.lists(items, max_size=60).map(b"".join),
        changed.map(lambda parts: parts[0][: parts[1]] + parts[2] + parts[0][parts[1] + parts[3] :]),
    )


@given(descriptors(), st.binary(max_size=80))
def test_nothing_raises(descriptor: bytes, report: bytes) -> None:
    parsed = parse_descriptor(descriptor)
    assert len(parsed.fields) <= MAX_FIELDS
    assert all(0 < field.size <= MAX_FIELD for field in parsed.fields)
    controls = read_report(parsed, report)
    assert controls == read_report(parsed, report)
    reached = {(field.report_id, field.bit) for field in parsed.fields if field.bit + field.size <= 8 * len(report)}
    assert len(controls) <= sum(field.count for field in parsed.fields if (field.report_id, field.bit) in reached)
