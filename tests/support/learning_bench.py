"""A move played several times on a simulated gimbal of any dynamics, and learned from, on the virtual clock."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any
from unittest import mock

from silent_screen import SilentScreen, no_signals

from teleop.app.learning import learner
from teleop.app.planning import Plan, plan_content
from teleop.app.play import devices_in_use, source_of
from teleop.app.sequence_run import SequenceReport, SequenceRun
from teleop.config.profile import Profile, load_profile
from teleop.core.clock import VirtualClock
from teleop.learning.correction import Correction
from teleop.learning.pass_learner import PassLearner
from teleop.sequence.cycle import Cycle

PAN = {"min": -170, "max": 170, "velocity": 120, "acceleration": 240, "jerk": 1200}
TILT = {"min": -50, "max": 140, "velocity": 90, "acceleration": 180, "jerk": 900}
FAST = {"keyframes": [{"at": 0, "pan": 0}, {"at": 2, "pan": 45, "hold": 0.5}, {"at": 5, "pan": -15}]}
SLOW = {"keyframes": [{"at": 0, "pan": -10}, {"at": 6, "pan": 40}]}
SETTLE = 4.0  # s, as `teleop play` has it


@dataclass(frozen=True)
class Learned:
    learner: PassLearner
    report: SequenceReport
    plan: Plan
    screen: SilentScreen
    saved: list[Correction]

    def rms(self, axis: str = "pan") -> list[float]:
        """Of each pass, in units."""
        return [
            next(error.rms for name, error in each.errors.items() if name.value == axis) for each in self.learner.passes
        ]


def rig(
    simulated: Mapping[str, Any] | None = None, mode: str = "speed", delay: float | None = None, **more: Any
) -> Profile:
    """A rig of one gimbal, whose simulated dynamics are as in a profile; `delay` (s) is what the profile has."""
    gimbal = {
        "type": "gimbal",
        "link": "gimbal",
        "mode": mode,
        "rate": 50,
        "delay": delay,
        "simulated": dict(simulated or {}),
    }
    content = {"name": "Bench", "links": {"gimbal": "sim:"}, "axes": {"pan": PAN, "tilt": TILT}, "sinks": [gimbal]}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "rig.yaml"
        file.write_text(json.dumps({**content, **more}))
        return load_profile(str(file))


def learned(
    profile: Profile,
    move: Mapping[str, Any],
    passes: int,
    folder: Path,
    known: Correction | None = None,
    changed: Callable[[SequenceRun], SequenceRun] = lambda run: run,
) -> Learned:
    """What was found of how the axes answer is kept in `folder`, for the next run there."""
    plan = plan_content(move, profile)
    used = devices_in_use(plan, shoots=False)
    screen = SilentScreen()
    saved: list[Correction] = []
    learns = learner(used, plan.sequence, folder / "a.learned.json", known, True, False, screen.notify)
    keep = learns.save
    learns.save = lambda correction: (saved.append(correction), keep(correction))
    cycle = Cycle(SETTLE, passes=passes, compared=True, corrector=learns)
    source = source_of(plan.sequence, used, 1.0, 1.0, cycle)
    run = SequenceRun(used, plan.sequence, source, VirtualClock(), None, screen.notify, screen.notify)
    run = changed(replace(run, patient=True, learner=learns))
    with mock.patch.dict(os.environ, {"XDG_STATE_HOME": str(folder / "state")}):
        report = run.perform(lambda _limits, _status, _recorder: screen, no_signals)
    return Learned(learns, report, plan, screen, saved)
