"""A timelapse being shot, tick by tick: each frame in its slot, in its order, and what happens when it is not."""

from __future__ import annotations

from pathlib import Path

import pytest
from timelapse_bench import Shoot, timelapse

from teleop.core.events import ShutterStep
from teleop.timelapse.phases import TimelapsePhase

SLOTS = {frame: 4.0 * frame for frame in range(5)}


@pytest.mark.parametrize("mode", ["shoot-move-shoot", "continuous"])
@pytest.mark.parametrize("prefocus", ["0s", "0.05s", "1.5s"])
def test_every_frame_is_shot_in_its_slot_and_focused_before(tmp_path: Path, mode: str, prefocus: str) -> None:
    shoot = Shoot(timelapse(tmp_path, f"mode: {mode}, prefocus: {prefocus}, settle: 0.3s"))
    shoot.run()
    assert shoot.source.phase is TimelapsePhase.OVER
    assert shoot.times(ShutterStep.PRESS) == pytest.approx(SLOTS)
    assert shoot.times(ShutterStep.RELEASE) == pytest.approx({frame: slot + 0.5 for frame, slot in SLOTS.items()})
    lead = max(0.1, float(prefocus.removesuffix("s")))
    focused = {frame: slot - lead for frame, slot in SLOTS.items()} if prefocus != "0s" else {}
    assert shoot.times(ShutterStep.FOCUS) == pytest.approx(focused)
    assert shoot.progress.late == shoot.progress.missed == 0
    assert shoot.progress.shot == 5
