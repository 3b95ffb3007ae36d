"""Reports: bits to values, null states, arrays, and descriptors from a model read back."""

from __future__ import annotations

import pytest
from hid_bench import Written, renumbered, values, written_descriptor, written_report
from hypothesis import given
from hypothesis import strategies as st

from teleop.inputs.hid.descriptor.parser import parse_descriptor
from teleop.inputs.hid.descriptor.report import Control, read_report

HAT = "0501 0939 1500 2507 7504 9501 8142"
KEYS = "0507 1904 2908 1501 2505 7508 9503 8100"  # an array: A..E are the numbers 1..5


def read(descriptor: str, report: str) -> list[Control]:
    return read_report(parse_descriptor(bytes.fromhex(descriptor)), bytes.fromhex(report))


def test_a_control_says_all_of_itself() -> None:
    assert read("0501 8507 0937 1581 257f 7508 9501 8106", "07ff") == [
        Control(7, 1, 0x37, "Dial", -1, -127, 127, relative=True, null=False)
    ]


@pytest.mark.parametrize(("value", "null"), [(0, False), (7, False), (8, True), (15, True)])
def test_a_hat_let_go_is_null(value: int, null: bool) -> None:
    (control,) = read(HAT, f"{value:02x}")
    assert (control.value, control.null) == (value, null)


def test_outside_the_range_without_a_null_state_is_a_value() -> None:
    (control,) = read(HAT.replace("8142", "8102"), "0f")
    assert (control.value, control.null) == (15, False)


def test_an_array_lists_what_is_on() -> None:
    assert read(KEYS, "020005") == [
        Control(0, 7, 5, "Key B", 1, 1, 5, relative=False, null=False, raw=2),
        Control(0, 7, 8, "Key E", 1, 1, 5, relative=False, null=False, raw=5),
    ]
    assert read(KEYS, "000000") == []
    assert read(KEYS, "06ff80") == []


@pytest.mark.parametrize(
    ("descriptor", "report", "names"),
    [
        ("0507 1904 2908 1500 25ff 7508 9503 8100", "000405", ["Key A", "Key E"]),  # 5 has no usage
        ("050c 09b0 09b1 09cd 09e2 1501 2504 7504 9502 8100", "42", ["Pause", "Mute"]),
        ("050c 09b0 0509 1901 2903 1501 2504 7504 9502 8100", "41", ["Play", "Button 3"]),
        ("0507 1904 2908 15fe 2502 7508 9503 8100", "fe0002", ["Key A", "Key C", "Key E"]),  # numbers from -2
        ("0507 1900 2908 1500 2508 7508 9503 8100", "000400", ["Key A"]),  # an idle place says usage 0, no event
        ("050c 1900 2aff03 1500 26ff03 7510 9502 8100", "0000cd00", ["Play/pause"]),
        ("0507 1904 2908 1501 2505 7508 9503 8140", "000006", []),
        ("1501 2505 7508 9503 8100", "010203", []),
        ("0507 1904 2908 1505 2501 7508 9503 8100", "010305", []),
    ],
)
def test_numbers_of_an_array(descriptor: str, report: str, names: list[str]) -> None:
    assert [control.name for control in read(descriptor, report)] == names


def test_an_array_cut_short_has_the_numbers_that_came() -> None:
    assert [control.name for control in read(KEYS, "0102")] == ["Key A", "Key B"]


def test_fields_past_a_short_report_are_left_out() -> None:
    descriptor = "0501 0930 0931 150026ff0f 750c 9502 8102"
    assert values(descriptor, "2341ab") == [("X", 0x123), ("Y", 0xAB4)]
    assert values(descriptor, "2341") == [("X", 0x123)]
    assert values(descriptor, "23") == []
    assert values(descriptor, "") == []


def test_more_than_the_descriptor_has_is_not_read() -> None:
    assert values("0501 0930 150026ff00 7508 9501 8102", "07ffff") == [("X", 7)]


def test_reports_of_other_ids_hold_nothing() -> None:
    descriptor = "0501 8501 0930 150026ff00 7508 9501 8102"
    assert values(descriptor, "0107") == [("X", 7)]
    assert values(descriptor, "0207") == []
    assert values(descriptor, "01") == []
    assert values(descriptor, "") == []


@pytest.mark.parametrize(
    ("size", "report", "value"),
    [
        (32, "ffffff7f", 0x7FFFFFFF),
        (32, "00000080", -0x80000000),
        (31, "00000040", -0x40000000),
        (64, "feffffffffffffff", -2),
        (1, "01", -1),
        (1, "00", 0),
    ],
)
def test_wide_and_narrow_signed_fields(size: int, report: str, value: int) -> None:
    assert values(f"0501 0930 15ff 2501 75{size:02x} 9501 8102", report) == [("X", value)]


@st.composite
def runs(draw: st.DrawFn) -> Written:
    size = draw(st.one_of(st.integers(1, 32), st.just(64)))
    signed = draw(st.booleans())
    width = min(size, 32)
    low, high = (-(1 << width - 1), (1 << width - 1) - 1) if signed else (0, (1 << min(width, 31)) - 1)
    ends = sorted((draw(st.integers(low, high)), draw(st.integers(low, high))))
    count = draw(st.integers(0, 12))
    first = draw(st.integers(0, 0xFF00))
    together = draw(st.booleans())
    many = draw(st.integers(0, 14))
    usages = (
        tuple(range(first, first + many)) if together else tuple(draw(st.lists(st.integers(0, 0xFFFF), max_size=many)))
    )
    return Written(
        report_id=draw(st.integers(0, 3)),
        size=size,
        page=draw(st.integers(1, 0xFFFF)),
        usages=usages,
        count=count,
        minimum=ends[0],
        maximum=ends[1],
        relative=draw(st.booleans()),
        has_null=draw(st.booleans()),
        constant=draw(st.integers(0, 5)) == 0,
        array=draw(st.integers(0, 3)) == 0,
        extended=draw(st.booleans()),
        as_range=together,
        raw=tuple(draw(st.integers(0, (1 << size) - 1)) for _ in range(count)),
    )


@given(st.lists(runs(), min_size=1, max_size=8), st.booleans())
def test_a_written_device_is_read_back(written: list[Written], numbered: bool) -> None:
    written = renumbered(written, numbered)
    descriptor = parse_descriptor(written_descriptor(written))
    for report_id in {run.report_id for run in written}:
        controls = read_report(descriptor, written_report(written, report_id))
        found = [
            (control.report_id, control.usage_page, control.usage, control.value, control.null) for control in controls
        ]
        mine = [run for run in written if run.report_id == report_id]
        assert found == [control for run in mine for control in run.expected()]
        ranges = {(run.minimum, run.maximum, run.relative) for run in mine}
        assert {(control.minimum, control.maximum, control.relative) for control in controls} <= ranges
