"""The profile that `live --learn` writes or updates, and the files that it never touches."""

from __future__ import annotations

from pathlib import Path

import pytest
from learn_bench import (
    REST,
    RIGHT,
    SIM,
    UP,
    LearnBench,
    Pad,
    Pads,
    Time,
    learning,
)

from teleop.app.learn.session import Stage
from teleop.config.profile import load_profile
from teleop.config.resources import folder
from teleop.core.errors import UsageError
from teleop.core.operator_input import Command

MINE = (
    SIM
    + """\
inputs:   # what is in the hand
  - name: Left pad   # with the red tape
    device: {vendor: 0x046d, product: 0xc216}
    # the left stick
    controls:
      Z: {axis: pan}    # was too fast
      Y: {axis: tilt, expo: 0.5}   # fine
      Rz: {axis: roll}   # stays
      Button 9: {press: quit}
sticks: {expo: 0.4}   # at the end
"""
)


def test_an_update_keeps_comments_skipped_controls_and_how_a_stick_is_shaped(rig: Path, time: Time, pad: Pad) -> None:
    rig.write_text(MINE)
    with learning(rig, time, Pads([pad])) as bench:
        bench.answer("PAN RIGHT", pad, RIGHT, REST)
        bench.answer("TILT UP", pad, UP, REST)
        bench.tried()
        bench.turn(0.1, Command.GO)
    expected = MINE.replace("      Z: {axis: pan}    # was too fast\n", "").replace(
        "expo: 0.5}", "expo: 0.5, invert: true}"
    )
    quits = "      Button 9: {press: quit}\n"
    assert rig.read_text() == expected.replace(quits, f"{quits}      X: {{axis: pan}}\n")


def test_what_a_named_pad_has_on_another_control_is_left_out(rig: Path, time: Time, pad: Pad) -> None:
    rig.write_text(SIM + "inputs:\n  - pad: logitech-gamepad   # as shipped\n")
    with learning(rig, time, Pads([pad])) as bench:
        bench.answer("PAN RIGHT", pad, "7f7fff7f08000000", REST)
        bench.tried()
        assert bench.session.trial is not None
        bench.turn(0.1, Command.GO)
    controls = load_profile(str(rig)).inputs[0].controls
    assert {name: each and each.axis for name, each in controls.items()} == {"X": None, "Z": "pan"}
    assert "pad: logitech-gamepad   # as shipped" in rig.read_text()


def test_a_shipped_rig_is_never_written_and_its_lines_are_printed(time: Time, pad: Pad) -> None:
    with learning("sim", time, Pads([pad])) as bench:
        bench.answer("PAN RIGHT", pad, RIGHT, REST)
        bench.tried()
        bench.turn(0.1, Command.GO)
        assert bench.session.stage is Stage.OUTPUT
        assert bench.session.output.endswith("    controls:\n      X: {axis: pan}\n")
    assert (folder("profiles") / "sim.yaml").read_text() == SIM
    with pytest.raises(UsageError, match="a shipped rig is never written"):
        learning("sim", time, Pads([pad]), folder("profiles") / "sim.yaml").__enter__()


def test_another_file_is_not_written_over_unasked(rig: Path, time: Time, pad: Pad, tmp_path: Path) -> None:
    out = tmp_path / "out.yaml"
    out.write_text("precious\n")
    with learning(rig, time, Pads([pad]), out) as bench:
        bench.answer("PAN RIGHT", pad, RIGHT, REST)
        bench.tried()
        bench.turn(0.1, Command.GO)
        assert bench.session.stage is Stage.CONFIRM
        bench.turn(0.1, Command.CLEAR)
        assert bench.session.stage is Stage.TRIAL
        assert out.read_text() == "precious\n"
        bench.turn(0.1, Command.GO)
        bench.turn(0.1, Command.KEEP)
    assert load_profile(str(out)).inputs[0].controls.keys() == {"X"}
    assert rig.read_text() == SIM


def test_a_file_that_changed_meanwhile_keeps_its_change(bench: LearnBench, pad: Pad, rig: Path) -> None:
    bench.answer("PAN RIGHT", pad, RIGHT, REST)
    bench.tried()
    changed = SIM.replace("name: Simulated rig", "name: Another name")
    rig.write_text(changed)
    bench.turn(0.1, Command.GO)
    assert rig.read_text().startswith(changed)
    assert load_profile(str(rig)).name == "Another name"


def test_a_file_that_is_no_profile_any_more_is_left_and_said(bench: LearnBench, pad: Pad, rig: Path) -> None:
    bench.answer("PAN RIGHT", pad, RIGHT, REST)
    bench.tried()
    rig.write_text("name: half a file\n")
    bench.turn(0.1, Command.GO)
    assert bench.session.stage is Stage.TRIAL
    assert "axes" in bench.session.problem
    assert rig.read_text() == "name: half a file\n"
