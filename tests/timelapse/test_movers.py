"""What takes the camera from frame to frame, in the shoot's own time."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from at_once import AtOnce
from timelapse_bench import LIMITS, timelapse

from teleop.core.axes import Axis, State
from teleop.timelapse.go_motion import mover_of
from teleop.timelapse.movers import GlideMover, StepMover
from teleop.timelapse.way import approach

REST = {Axis.PAN: State(0.0)}


@pytest.mark.parametrize("frame", [0, 2, 4])
def test_a_frame_is_approached_from_the_side_that_the_move_comes_from(tmp_path: Path, frame: int) -> None:
    positions = timelapse(tmp_path).path.positions(5)
    place = {Axis.PAN: float(positions[Axis.PAN][frame])}
    way = approach(0.0, {Axis.PAN: State(90.0)}, place, positions, frame, LIMITS)
    assert way.at(way.arrival)[Axis.PAN] == State(place[Axis.PAN])
    assert way.at(way.arrival - 0.05)[Axis.PAN].velocity > 0, "upward, as the pan goes"


def test_in_steps_it_rests_at_each_frame_and_keeps_the_clock(tmp_path: Path) -> None:
    found = timelapse(tmp_path)
    mover = StepMover(found)
    mover.approach(0.0, REST, 1)
    mover.begin(20.0, found.slots.at(1))
    assert (mover.time(20.0), mover.when(found.slots.at(2), 0.0)) == (4.0, 24.0)
    place = float(found.path.positions(5)[Axis.PAN][1])
    assert mover.at(mover.arrival)[Axis.PAN] == State(place)
    assert not mover.step(20.0, 1, 3.0), "it is there"
    assert mover.step(20.0, 2, 3.0)
    assert mover.next_motion(20.0) == 20.0
    assert math.isinf(mover.next_motion(mover.arrival))
    assert mover.skip(20.0, 4.0), "it can wait for the next slot"
    assert mover.when(found.slots.at(2), 0.0) == 28.0


@pytest.mark.parametrize("frame", [0, 2])
def test_a_glide_is_at_each_frame_in_its_slot(tmp_path: Path, frame: int) -> None:
    found = timelapse(tmp_path, "mode: continuous")
    mover = GlideMover(found, AtOnce())
    mover.approach(0.0, REST, frame)
    slot = math.ceil(mover.arrival + mover.run_up + 1)
    mover.begin(slot, found.slots.at(frame))
    positions = found.path.positions(5)[Axis.PAN]
    for later in range(frame, 5):
        at = slot + found.slots.at(later) - found.slots.at(frame)
        assert mover.time(at) == pytest.approx(found.slots.at(later))
        assert mover.at(at)[Axis.PAN].position == pytest.approx(float(positions[later]), abs=1e-6)
    assert not mover.skip(20.0, 4.0), "the place of a frame is passed"


@pytest.mark.parametrize("options", ["mode: continuous", "mode: shoot-move-shoot", "blur: 0.2"])
def test_what_a_mover_foresees_is_what_it_does(tmp_path: Path, options: str) -> None:
    found = timelapse(tmp_path, options)
    mover = mover_of(found, AtOnce())
    mover.approach(0.0, REST, 0)
    slot = math.ceil(mover.arrival + mover.run_up + 2)
    mover.begin(slot, found.slots.at(0))
    foreseen: dict[int, State] = {}
    for number in range(100 * (slot + 2)):
        here = mover.at(number / 100)[Axis.PAN]
        assert here == pytest.approx(foreseen.get(number, here), abs=1e-9)
        foreseen[number + 20] = mover.foreseen((number + 20) / 100)[Axis.PAN]


def test_before_a_glide_moves_its_time_runs_as_the_clock_does(tmp_path: Path) -> None:
    found = timelapse(tmp_path, "mode: continuous")
    mover = GlideMover(found, AtOnce())
    mover.approach(0.0, REST, 0)
    mover.begin(50.0, 0.0)
    assert mover.time(48.5) == -1.5
    assert mover.when(-1.5, 20.0) == 48.5
    mover.pause(30.0)
    assert mover.time(40.0) == -math.inf, "nothing is due while it is paused"
    mover.resume(60.0, 0.0, 2.0)
    assert mover.time(62.0) == 0.0
