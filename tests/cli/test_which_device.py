"""Which of several devices an input takes, and what is said of it; all on recordings, played on the virtual clock."""

from __future__ import annotations

from pathlib import Path

import pytest
from played import BUTTON, HAT, JOYSTICK, NULL, SLIDER, Player, X, Y, collection, held, inputs

from teleop.core.axes import Axis

STICK = collection(JOYSTICK, inputs([X, Y], 0, 255, 8), inputs(range(1, 9), 0, 1, 1, page=BUTTON))
REST, RIGHT = b"\x7f\x7f\0", b"\xff\x7f\0"
PUSHED = [*held(REST, 0, 1), *held(RIGHT, 1, 2), *held(REST, 2, 2.5)]
STILL = held(REST, 0, 2.5)
MODEL = "vendor: 0x1234, product: 0x5678"


@pytest.fixture
def player(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Player:
    return Player(tmp_path, capsys)


def two(left: str, right: str) -> str:
    """A profile of two inputs, one of which pans and the other tilts."""
    return (
        f"inputs:\n  - {{name: Left, device: {{{left}}}, controls: {{X: {{axis: pan}}}}}}\n"
        f"  - {{name: Right, device: {{{right}}}, controls: {{X: {{axis: tilt}}}}}}\n"
    )


@pytest.mark.parametrize(
    ("one", "other", "cure"),
    [
        ({"port": "1-2"}, {"port": "1-3"}, "add port: 1-2 or port: 1-3 to the device of each input"),
        ({"serial": "A"}, {"serial": "B"}, "add serial: A or serial: B to the device of each input"),
        ({"serial": "0123"}, {"serial": "0124"}, 'add serial: "0123" or serial: "0124" to the device of each input'),
        ({"serial": "A", "port": "1-2"}, {"serial": "A", "port": "1-3"}, "add port: 1-2 or port: 1-3 to the device"),
        ({}, {}, "unplug one"),
    ],
)
def test_two_devices_that_two_inputs_name_alike_stay_locked_with_the_cure(
    player: Player, one: dict[str, str], other: dict[str, str], cure: str
) -> None:
    devices = player.device(STICK, PUSHED, **one), player.device(STICK, PUSHED, **other)
    played = player.play(*devices, profile=two(MODEL, MODEL))
    assert not played.moved
    for name, rival in (("Left", "Right"), ("Right", "Left")):
        line = f"{name}: 2 of Strange pad are plugged in, and {rival} is for them too; {cure}"
        assert line in played.lines


def test_one_of_them_alone_is_for_the_first_input_and_the_second_stays_locked_beside_it(player: Player) -> None:
    later = [(1.2, b""), *held(REST, 1.3, 2), *held(RIGHT, 2, 2.5)]
    devices = player.device(STICK, PUSHED, port="1-2"), player.device(STICK, later, port="1-3")
    played = player.play(*devices, profile=two(MODEL, MODEL))
    assert played.moved == {Axis.PAN}
    assert "Left: using Strange pad (1234:5678), port 1-2" in played.lines
    assert "Right: 2 of Strange pad are plugged in, and Left is for them too" in played.lines


def test_a_serial_number_is_more_exact_than_ids_and_the_other_pad_is_the_other_inputs(player: Player) -> None:
    devices = player.device(STICK, PUSHED, serial="B"), player.device(STICK, STILL, serial="A")
    played = player.play(*devices, profile=two(MODEL, "serial: B"))
    assert played.moved == {Axis.TILT}


def test_one_input_for_two_pads_takes_one_and_says_which_and_the_spare_when_it_is_lost(player: Player) -> None:
    lost = [*held(REST, 0, 1), *held(RIGHT, 1, 1.5), (1.5, None)]
    spare = [*held(REST, 0, 4), *held(RIGHT, 4, 5), *held(REST, 5, 5.5)]
    devices = player.device(STICK, lost, port="1-2"), player.device(STICK, spare, port="1-3")
    played = player.play(*devices, profile=f"inputs:\n  - {{name: Left, device: {{{MODEL}}}}}\n")
    assert played.at(Axis.PAN, 3.9) < played.last(Axis.PAN) - 1
    for port in ("1-2", "1-3"):
        assert f"Left: using Strange pad (1234:5678), port {port}" in played.lines


def test_a_spare_that_another_input_is_for_is_not_taken(player: Player) -> None:
    lost = [*held(REST, 0, 1), (1.0, None)]
    devices = player.device(STICK, lost, port="1-2"), player.device(STICK, held(REST, 0, 5), port="1-3")
    played = player.play(*devices, profile=two(f"{MODEL}, port: 1-3", MODEL))
    assert "Right: using" not in played.lines
    assert "Right: unplugged" in played.lines


def test_an_interface_of_a_receiver_is_chosen_by_its_number(player: Player) -> None:
    devices = [player.device(STICK, PUSHED, port="1-2", interface=number) for number in (0, 1)]
    profile = f"inputs:\n  - {{device: {{{MODEL}, interface: 1}}, controls: {{X: {{axis: tilt}}}}}}\n"
    assert player.play(devices[0], profile=profile).moved == set()
    assert player.play(*devices, profile=profile).moved == {Axis.TILT}


def test_of_a_receiver_without_a_serial_number_and_a_port_to_be_seen_the_interface_that_speaks_is_found(
    player: Player,
) -> None:
    silent, speaking = (player.device(STICK, rows, interface=number) for number, rows in enumerate(([], PUSHED)))
    assert player.play(silent, speaking).moved == {Axis.PAN}


def test_of_a_receiver_the_second_interface_speaks_and_the_first_one_later_changes_nothing(player: Player) -> None:
    first = player.device(STICK, held(RIGHT, 3, 4), port="1-2", interface=0)
    second = player.device(STICK, [*PUSHED, *held(REST, 2.5, 4)], port="1-2", interface=1)
    played = player.play(first, second)
    assert played.at(Axis.PAN, 2.5) > 1
    assert played.last(Axis.PAN) == played.at(Axis.PAN, 2.5)


def test_a_center_that_is_kept_is_that_of_the_pad_in_this_port(player: Player) -> None:
    off = b"\x8b\x7f\0"  # 9 % to the right, where the first pad rests
    first = [*held(off, 0, 1), (1.0, None), (6.0, b""), *held(off, 6, 7.5)]
    second = [(2.0, b""), *held(REST, 2, 4), *held(RIGHT, 4, 4.5), *held(REST, 4.5, 5), (5.0, None)]
    devices = player.device(STICK, first, port="1-2"), player.device(STICK, second, port="1-3")
    played = player.play(*devices, profile=f"sticks: {{dead_zone: 0.02}}\ninputs:\n  - device: {{{MODEL}}}\n")
    assert played.at(Axis.PAN, 3.95) == 0
    assert played.at(Axis.PAN, 4.9) > 0.1, "the second pad rests in the middle, and works"
    assert played.last(Axis.PAN) == played.at(Axis.PAN, 5.5)
    assert "using Strange pad (1234:5678), port 1-3" in played.lines


RIGHT_STICK = collection(JOYSTICK, inputs([X, Y, 0x32, 0x35], 0, 255, 8), inputs(range(1, 9), 0, 1, 1, page=BUTTON))


@pytest.mark.parametrize("end", [0x00, 0xFF])
def test_a_guessed_right_stick_held_at_an_end_works_once_it_was_centered(player: Player, end: int) -> None:
    rest = b"\x7f\x7f\x7f\x7f\0"
    rows = [
        *held(bytes([0x7F, 0x7F, end, 0x7F, 0]), 0, 1),
        *held(rest, 1, 2.5),
        *held(b"\x7f\x7f\xff\x7f\0", 2.5, 3),
        *held(rest, 3, 3.5),
    ]
    played = player.play(player.device(RIGHT_STICK, rows))
    assert played.at(Axis.ROLL, 2.45) == 0
    assert played.moved == {Axis.ROLL}


def test_guessed_triggers_never_are_a_stick_also_when_one_is_held_half_way(player: Player) -> None:
    rest, half = b"\x7f\x7f\0\0\0", b"\x7f\x7f\x80\0\0"
    rows = [*held(rest, 0, 1), *held(half, 1, 3), *held(b"\x7f\x7f\xff\0\0", 3, 3.5), *held(rest, 3.5, 4.5)]
    assert not player.play(player.device(RIGHT_STICK, rows)).moved


HATS = collection(
    JOYSTICK, inputs([X, SLIDER], 0, 255, 8), inputs([HAT], 0, 3, 4, NULL), inputs([1, 2, 3, 4], 0, 1, 1, page=BUTTON)
)


def test_a_hat_held_stores_a_preset_and_pressed_recalls_it_and_a_switchs_first_throw_counts(player: Player) -> None:
    rest, right, up, thrown = b"\x7f\0\x0f", b"\xff\0\x0f", b"\x7f\0\0", b"\x7f\xff\x0f"
    rows = [
        *held(rest, 0, 0.5),
        *held(up, 0.5, 1.8),  # stored at 0
        *held(rest, 1.8, 2),
        *held(right, 2, 3),
        *held(rest, 3, 3.5),
        *held(up, 3.5, 3.6),  # recalled
        *held(rest, 3.6, 8),
        *held(thrown, 8, 11),
    ]
    profile = (
        "presets: {recall: 2s}\nsticks: {start_range: 3}\ninputs:\n  - controls:\n      X: {axis: pan}\n"
        "      Slider: {axis: focus, by: position}\n      Hat switch: {up: {press: recall, number: 1, hold: store}}\n"
    )
    played = player.play(player.device(HATS, rows), profile=profile)
    assert "preset 1 stored" in played.lines
    assert played.at(Axis.PAN, 3.4) > 5
    assert played.at(Axis.PAN, 7.5) == pytest.approx(0, abs=1e-6)
    assert played.at(Axis.FOCUS, 7.9) == played.at(Axis.FOCUS, 0.0)
    assert played.last(Axis.FOCUS) == pytest.approx(1, abs=1e-3)


def test_the_only_pad_may_be_plugged_in_in_the_middle_of_the_run(player: Player) -> None:
    rows = [(1.0, b""), *held(REST, 1, 3), *held(RIGHT, 3, 3.5), *held(REST, 3.5, 4)]
    assert player.play(player.device(STICK, rows)).moved == {Axis.PAN}
