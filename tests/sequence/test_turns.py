"""Axes without ends: whole turns loop, the short way round where it is asked for, a remark on a long one."""

from __future__ import annotations

from pathlib import Path

import pytest

from teleop.config.documents.document import DocumentError
from teleop.core.axes import Axis, Limits
from teleop.sequence.compile import CompiledSequence, load_sequence

ENDLESS = {Axis.PAN: Limits(float("-inf"), float("inf"), 120, 240, 1200), Axis.TILT: Limits(-56, 146, 90, 180, 900)}


def load(folder: Path, text: str) -> CompiledSequence:
    (folder / "round.yaml").write_text(text)
    return load_sequence(str(folder / "round.yaml"), ENDLESS, "the rig")


def positions(sequence: CompiledSequence) -> list[float]:
    return [key.position for key in sequence.keys[Axis.PAN]]


def test_whole_turns_loop_and_go_on(tmp_path: Path) -> None:
    move = load(tmp_path, "repeat: {times: 3, mode: loop}\nkeyframes: [{at: 0, pan: 0}, {at: 10, pan: 360}]\n").move
    assert move.duration == 30
    assert move.at(30)[Axis.PAN].position == 1080
    assert move.at(10)[Axis.PAN].velocity > 30
    with pytest.raises(DocumentError, match="a loop must end where it began, at 0, not 350"):
        load(tmp_path, "repeat: {times: 3, mode: loop}\nkeyframes: [{at: 0, pan: 0}, {at: 10, pan: 350}]\n")


def test_the_long_way_round_is_said_and_the_short_one_is_for_the_asking(tmp_path: Path) -> None:
    text = "keyframes:\n  - {at: 0, pan: 170}\n  - {at: 9, pan: -170}\n"
    long = load(tmp_path, text)
    assert positions(long) == [170, -170]
    (warning,) = long.warnings
    assert warning.endswith(
        "round.yaml:3:5: pan goes 340 deg round from key 1 to key 2; with `through: shortest` it goes 20 deg"
    )
    for short in (text.replace("-170", "-170, through: shortest"), "through: shortest\n" + text):
        sequence = load(tmp_path, short)
        assert positions(sequence) == [170, 190]
        assert sequence.warnings == []


def test_keys_after_a_short_way_stay_in_its_turn(tmp_path: Path) -> None:
    text = "keyframes: [{at: 0, pan: 170}, {at: 4, pan: -170, through: shortest}, {at: 9, pan: -90}, {at: 20, pan: 0}]"
    assert positions(load(tmp_path, text)) == [170, 190, 270, 360]


def test_a_whole_turn_is_no_long_way_and_an_axis_with_ends_has_no_short_one(tmp_path: Path) -> None:
    assert load(tmp_path, "keyframes: [{at: 0, pan: 0}, {at: 20, pan: 360}]\n").warnings == []
    with pytest.raises(DocumentError, match="on the rig tilt cannot turn round: it has a min"):
        load(tmp_path, "keyframes: [{at: 0, tilt: 0}, {at: 20, tilt: 90, through: shortest}]\n")
