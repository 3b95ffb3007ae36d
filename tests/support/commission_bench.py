"""A commissioning on the virtual clock, with an operator who sees what the simulated gimbal really does."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from teleop.app.commission.profile_file import ProfileFile
from teleop.app.commission.session import Commissioning
from teleop.commission.findings import Findings
from teleop.commission.page import GO, REPEAT, SKIP, STOP, Page, Stage
from teleop.config.profile import Profile, load_profile
from teleop.config.sinks_section import GimbalSection
from teleop.core.clock import VirtualClock
from teleop.core.errors import UsageError
from teleop.inputs.hid.backend import HidBackend
from teleop.sim.gimbal.device import SimulatedGimbal

TICK = 0.01  # s
LONGEST = 1500.0  # s
WAYS = {"turn right": 0, "roll clockwise": 1, "tilt up": 2}
SOFT = {"pan": (-20.0, 30.0), "tilt": (-10.0, 16.0), "roll": (-6.0, 8.0)}
"""Where the operator marks the ends."""


@dataclass
class Operator:
    """Answers by what the gimbal really does, in the signs of `core.axes`."""

    gimbal: SimulatedGimbal
    soft: Mapping[str, tuple[float, float]] = field(default_factory=lambda: SOFT)
    skips: Callable[[Page], bool] = lambda _page: False
    troubles: list[str] = field(default_factory=list)
    began: tuple[float, ...] = (0.0, 0.0, 0.0)
    mount: float = 0.0
    asked: float = 0.0
    was: str = ""
    tried: set[str] = field(default_factory=set)
    marked: dict[tuple[str, bool], float] = field(default_factory=dict)  # by axis, and whether it is the lower end

    def keys(self, page: Page, now: float) -> list[str]:
        seen = f"{page.key} {page.stage} {page.question}"
        if seen != self.was:
            self.was, self.asked = seen, now
            if page.stage is Stage.PROMPT:
                self.began = tuple(self.gimbal.angles)
            return []
        if now - self.asked < 0.3:
            return []
        self.asked = now
        match page.stage:
            case Stage.PROMPT:
                return [SKIP if self.skips(page) else GO]
            case Stage.SHOWN:
                return [self._result(page)]
            case Stage.ASKING:
                return self._answer(page)
        return []

    def _result(self, page: Page) -> str:
        if not page.trouble:
            return GO
        self.troubles.append(f"{page.key}: {page.trouble}")
        if page.key in self.tried:
            return SKIP
        self.tried.add(page.key)
        return REPEAT

    def _answer(self, page: Page) -> list[str]:
        question, angles = page.question, self.gimbal.angles
        for way, index in WAYS.items():
            if way in question:
                moved = angles[index] - self.began[index]
                return ["u" if abs(moved) < 0.1 else "y" if moved > 0 else "n"]
        if "straight ahead" in question:
            return ["y" if abs(angles[0] - self.mount) < 2 and abs(angles[2]) < 2 else "n"]
        if "Drive" in question:
            return self._drive(page)
        answers = {"model": "4", "follow": "y", "focus?": "f", "press space": STOP}
        return [next((key for words, key in answers.items() if words in question), "y")]

    def _drive(self, page: Page) -> list[str]:
        name = page.key.rpartition("-")[2]
        index = {"pan": 0, "roll": 1, "tilt": 2}[name]
        first = any(word in page.question for word in ("left end", "lower", "counterclockwise"))
        target = self.soft[name][0 if first else 1]
        here = self.gimbal.angles[index] - (self.mount if index == 0 else 0)
        left = target - here
        up, down = ("up", "down") if name == "tilt" else ("right", "left")
        self.was = ""
        if abs(left) < 1.6:
            self.marked[name, first] = here
            return [GO]
        coarse = {"pan": ("L", "H"), "tilt": ("K", "J"), "roll": ("L", "H")}[name]
        if abs(left) >= 10:
            return [coarse[0] if left > 0 else coarse[1]]
        return [up if left > 0 else down]


def no_devices() -> HidBackend:
    raise UsageError("no joystick found")


class CommissionBench:
    """`rig` is a profile or its name; `options` are those of the SimulatedGimbal, `out` is where the profile goes."""

    def __init__(self, out: Path, rig: str = "sim", **options: Any) -> None:
        self.clock = VirtualClock(100.0)
        self.gimbal = SimulatedGimbal(**options)
        self.file = ProfileFile(rig, out)
        profile = load_profile(rig)
        self.made = Commissioning(profile, self.file, self.clock, no_devices, polled=True, simulated=self.gimbal)
        self.runner = self.made.runner
        self.operator = Operator(self.gimbal, mount=options.get("mount", 0.0))
        self.fastest = [0.0, 0.0, 0.0]  # deg/s since the last page that asked for more was left
        self.furthest = [0.0, 0.0, 0.0]
        self.watch: Callable[[], object] = lambda: None
        self.began = self.gimbal.angles

    def turn(self, *keys: str) -> None:
        self.runner.turn(self.clock.now(), keys)
        self.clock.sleep_until(self.clock.now() + TICK)
        self.watch()

    def run(self, until: str = "") -> Findings:
        """To the end, or to the page of the step `until`."""
        end = self.clock.now() + LONGEST
        while not self.runner.over and (page := self.runner.page).key != until:
            assert self.clock.now() < end, page
            self.turn(*self.operator.keys(page, self.clock.now()))
        return self.made.findings

    @property
    def profile(self) -> Profile:
        """As it was written."""
        return load_profile(str(self.file.file))

    @property
    def section(self) -> GimbalSection:
        section = self.profile.sinks[0]
        assert isinstance(section, GimbalSection)
        return section
