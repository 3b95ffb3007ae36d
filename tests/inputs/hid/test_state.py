"""What is kept of a device's reports: values, changes, and whether it reports all the time. Bytes of real devices."""

import pytest
from fake_hid import real

from teleop.inputs.hid.cadence import STEADY
from teleop.inputs.hid.descriptor.parser import parse_descriptor
from teleop.inputs.hid.state import HidState, Sample


def state_of(name: str, bus: str = "") -> HidState:
    return HidState(parse_descriptor(bytes.fromhex(real(name, bus)["descriptor"])))


def take(state: HidState, *reports: str, now: float = 0.0) -> None:
    for report in reports:
        state.take(bytes.fromhex(report), now)


F310_REST = "7f7f7f7f08000000"


def test_every_control_is_there_by_its_name_and_vendors_fields_are_not() -> None:
    state = state_of("Logitech F310")
    take(state, "ff007f7f08000000")
    assert state.values["X"] == Sample(255, 0, 255)
    assert state.values["Y"].value == 0
    assert {"X", "Y", "Z", "Rz", "Hat switch", "Hat switch up", "Button 12"} <= state.names
    assert not any(name.startswith("Vendor") for name in state.names | state.values.keys())


@pytest.mark.parametrize(
    ("nibble", "pressed"),
    [
        (0, {"up"}),
        (1, {"up", "right"}),
        (2, {"right"}),
        (3, {"right", "down"}),
        (4, {"down"}),
        (5, {"down", "left"}),
        (6, {"left"}),
        (7, {"left", "up"}),
        (8, set()),
        (15, set()),
    ],
)
def test_a_hat_is_four_buttons(nibble: int, pressed: set[str]) -> None:
    state = state_of("Logitech F310")
    take(state, f"7f7f7f7f{nibble:02x}000000")
    assert {way for way in ("up", "right", "down", "left") if state.values[f"Hat switch {way}"].pressed} == pressed


def test_a_hat_that_counts_from_one_is_the_same() -> None:
    state = state_of("Microsoft Xbox One S")
    take(state, "01ff7fff7fff7fff7f0000000003000000")
    assert state.values["Hat switch right"].pressed
    assert not state.values["Hat switch up"].pressed


def test_changes_of_watched_controls_are_queued_in_order_and_given_once() -> None:
    state = state_of("Logitech F310")
    state.watched = {"Button 1"}
    take(state, "7f7f7f7f18000000", now=1)
    assert list(state.changes()) == []
    take(state, F310_REST, now=2)
    take(state, "ff7f7f7f18000000", now=3)
    assert [(change.time, change.name, change.sample.pressed) for change in state.changes()] == [
        (2, "Button 1", False),
        (3, "Button 1", True),
    ]
    assert list(state.changes()) == []


def test_each_count_of_a_wheel_is_queued_and_none_when_it_says_nothing() -> None:
    state = state_of("Huion KeyDial")
    state.watched = {"Dial"}
    take(state, "110001000000000000", "110001000000000000", "110000000000000000", "1100ffff0000000000")
    assert [change.sample.value for change in state.changes()] == [1, 1, -1]


def test_a_control_that_is_described_wrongly_is_read_as_told() -> None:
    state = state_of("3Dconnexion SpaceNavigator")
    assert "X" in state.relative
    state.counting = {"X": False}
    take(state, "01a2fe5e01a2fe")
    assert (state.values["X"].relative, state.values["Y"].relative) == (False, True)


def test_several_reports_make_one_device() -> None:
    state = state_of("3Dconnexion SpaceNavigator")
    take(state, "01a2fe5e01a2fe", "025e01a2fe0000", "030100")
    assert (state.values["X"].value, state.values["Rx"].value, state.values["Button 1"].value) == (-350, 350, 1)
    assert list(state.report_ids(["Rx", "Button 2", "X"])) == [1, 2, 3]


def test_a_device_that_repeats_itself_reports_all_the_time() -> None:
    state = state_of("Logitech F310")
    take(state, *[F310_REST] * STEADY)
    assert not state.cadence.steady
    take(state, F310_REST)
    assert state.cadence.steady


def test_one_that_reports_changes_never_repeats_itself() -> None:
    state = state_of("Logitech F310")
    for index in range(200):
        take(state, F310_REST if index % 2 else "807f7f7f08000000")
        state.take(bytes.fromhex(F310_REST), index, asked=True)
    assert not state.cadence.steady


def test_when_it_reported_last_and_when_something_new() -> None:
    state = state_of("Logitech F310")
    take(state, F310_REST, now=1)
    take(state, F310_REST, now=2)
    assert (state.last, state.differed) == (2, 1)
    take(state, "ff7f7f7f08000000", now=3)
    assert (state.last, state.differed) == (3, 3)


def test_a_report_without_the_mapped_controls_is_no_sign_of_life() -> None:
    state = state_of("Microsoft Xbox One S")
    state.vital = frozenset({1})
    take(state, "0464", now=5)
    assert state.last < 0


def test_what_a_short_report_does_not_reach_has_no_value_and_is_not_pressed() -> None:
    state = state_of("Logitech F310")
    state.watched = {"Button 1"}
    take(state, "ff007f7f18000000", "ff", now=1)
    assert state.values["X"].value == 255
    assert state.values["Y"].null
    assert not state.values["Button 1"].pressed
    assert [change.sample.pressed for change in state.changes()] == [False]


def test_nonsense_is_no_report() -> None:
    state = state_of("Sony DualShock 4", "usb")
    take(state, "", "ff", "6300112233")
    assert state.values == {}


@pytest.mark.parametrize(("interval", "patience"), [(0.01, 0.2), (0.25, 0.625), (0.5, 1.25), (30.0, 0.2)])
def test_how_long_a_silence_is_normal_is_learned_from_the_device(interval: float, patience: float) -> None:
    state = HidState(parse_descriptor(bytes.fromhex(real("Logitech F310")["descriptor"])))
    for index in range(12):
        state.take(bytes.fromhex("7f7f7f7f08000000"), index * interval)
    assert state.cadence.patience == pytest.approx(patience)
    assert state.cadence.has_heartbeat is (0.2 < interval < 1)


def test_a_roll_onto_a_diagonal_queues_no_press_of_the_neighbor() -> None:
    state = HidState(parse_descriptor(bytes.fromhex(real("Logitech F310")["descriptor"])))
    state.watched = {"Hat switch up", "Hat switch right"}
    for hat in ("08", "00", "01", "02", "08"):
        state.take(bytes.fromhex(f"7f7f7f7f{hat}000000"), 0)
    assert [(change.name, change.sample.value) for change in state.changes()] == [
        ("Hat switch up", 1),
        ("Hat switch up", 0),
    ]


def test_a_report_without_controls_that_is_repeated_says_nothing_of_those_before() -> None:
    state = HidState(parse_descriptor(bytes.fromhex(real("Logitech F310")["descriptor"])))
    state.take(bytes.fromhex(F310_REST), 1.0)
    for time in (2.0, 2.1, 2.2):
        state.take(b"", time)
        assert (state.last, state.opaque) == (1.0, (0, time))
