"""A planned move as a program sees it."""

from __future__ import annotations

import math
import subprocess
import sys

import numpy as np
import pytest

import teleop

SHORT = {"keyframes": [{"at": 0, "pan": 0, "tilt": 5}, {"at": 2, "pan": 10, "tilt": 5}]}
TYPED = """
# pyright: strict
import teleop
from typing import assert_type

move = teleop.plan({"keyframes": [{"at": 0, "pan": 0}]}, rig="rs2")
assert_type(move.at(1)["pan"].position, float)
position = move.sample([0, 1])["pan"].position
print(position.shape, move.peaks()["pan"].velocity, move.duration)
with teleop.open("sim", links={"gimbal": "sim:"}, virtual=True) as rig:
    rig.move(pan=30, tilt=5, seconds=2)
    rig.jog(pan=10, seconds=1)
    report = rig.play("shoot.yaml", take="a.mcap")
    print(rig.angles()["pan"] + report.axes["pan"].rms + report.axes["pan"].peak, report.ok, report.reason)
"""


@pytest.fixture
def move():
    return teleop.plan(SHORT)


def test_states_and_samples_are_keyed_by_plain_names(move):
    for found in (move.at(1), move.sample([0, 1]), move.peaks()):
        assert [type(name) for name in found] == [str, str]
        assert list(found) == ["pan", "tilt"]


def test_a_sample_has_named_rows(move):
    times = np.linspace(0, 2, 5)
    pan = move.sample(times)["pan"]
    assert pan.shape == (4, 5)
    states = [move.at(time)["pan"] for time in times]
    assert pan.position == pytest.approx([state.position for state in states])
    assert pan.velocity == pytest.approx([state.velocity for state in states], abs=1e-9)
    assert pan.acceleration == pytest.approx([state.acceleration for state in states], abs=1e-9)
    assert np.array_equal(pan.jerk, np.asarray(pan)[3])
    assert type(pan.position) is np.ndarray


@pytest.mark.parametrize("times", [1.0, [math.nan], [[0, 1]], ["now"]])
def test_times_that_are_not_a_list_of_numbers_are_refused(move, times):
    with pytest.raises(teleop.UsageError, match="sample: times must be"):
        move.sample(times)


@pytest.mark.parametrize("time", [math.nan, math.inf])
def test_a_time_that_is_not_finite_is_refused(move, time):
    with pytest.raises(teleop.UsageError, match="finite"):
        move.at(time)


def test_before_and_after_the_move_the_axes_rest(move):
    assert move.at(-1)["pan"] == (0, 0, 0)
    assert move.at(99)["pan"] == pytest.approx((10, 0, 0))


def test_a_figure_without_matplotlib_is_an_error_with_its_cure(move, monkeypatch):
    for name in [*(each for each in sys.modules if each.startswith("matplotlib")), "matplotlib.figure"]:
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(teleop.UsageError, match=r"pip install 'rs-teleop\[plot\]'"):
        move.plot()


def test_a_move_is_shown_in_one_short_line(move):
    assert repr(move) == "<Move 'sequence': 2.00 s of pan, tilt on Simulated rig>"


def test_programs_are_typed_strictly(tmp_path):
    pyright = pytest.importorskip("pyright", reason="pyright is an extra of development")
    file = tmp_path / "program.py"
    file.write_text(TYPED)
    command = [sys.executable, "-m", pyright.__name__, "--pythonpath", sys.executable, str(file)]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=110, check=False, cwd=tmp_path)
    assert ran.returncode == 0, ran.stdout
