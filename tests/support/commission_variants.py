"""Gimbals in every variant of the known unknowns, and what a right profile of each has in it.

What is expected is worked out from the variant itself, here, by nothing that the program or its simulator shares.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from commission_bench import CommissionBench
from hypothesis import strategies as st

from teleop.sim.gimbal.dynamics import Dynamics
from teleop.sim.gimbal.firmware import Firmware

AXES = "pan", "roll", "tilt"  # of yaw, roll and pitch
ORDERS = "yaw-roll-pitch", "yaw-pitch-roll", "all-yaw-pitch-roll"


@dataclass(frozen=True)
class Variant:
    """Signs are of yaw, roll and pitch, against `core.axes`. `held` is the axis that a hand holds, if any."""

    signs: tuple[int, int, int] = (1, 1, 1)
    speed_signs: tuple[int, int, int] = (1, 1, 1)
    report_signs: tuple[int, int, int] = (1, 1, 1)
    replies: str = "new"  # new, bare, legacy
    order: str = "yaw-roll-pitch"
    refuses: tuple[str, ...] = ()
    ignores_speed: bool = False
    silent_pushes: bool = False
    silent_angles: bool = False
    focus_motor: str = "calibrated"
    drift: float = 0.0
    lag: float = 0.05
    dead_time: float = 0.0
    mount: float = 0.0
    boot: tuple[float, float, float] = (0.0, 0.0, 0.0)
    held: str = ""
    bus_errors: float = 0.0
    reset: float = 0.0

    def bench(self, folder: Path) -> CommissionBench:
        firmware: Any = Firmware(
            speed_signs=self.speed_signs,
            report_signs=self.report_signs,
            legacy_replies=self.replies == "legacy",
            bare_replies=self.replies == "bare",
            legacy_order=self.order,  # type: ignore[arg-type]
            refuses=self.refuses,  # type: ignore[arg-type]
            ignores_speed=self.ignores_speed,
            silent_pushes=self.silent_pushes,
            silent_angles=self.silent_angles,
            focus_motor=self.focus_motor,  # type: ignore[arg-type]
        )
        dynamics = Dynamics(drift=self.drift, lag=self.lag, dead_time=self.dead_time)
        options: Any = {"signs": self.signs, "firmware": firmware, "dynamics": dynamics}
        rig, out = folder / "rig.yaml", folder / "out.yaml"
        out.unlink(missing_ok=True)
        rig.write_text(RIG.replace("SIMULATED", f"{{bus_errors: {self.bus_errors}, adapter_reset: {self.reset}}}"))
        bench = CommissionBench(out, str(rig), mount=self.mount, boot=self.boot, **options)
        if self.held:
            hand = {("yaw", "roll", "pitch")[AXES.index(self.held)]: True}
            bench.gimbal.hold(bench.clock.now(), **hand)
        return bench


RIG = """# A rig of mine: this comment stays.
name: Mine
links: {gimbal: "sim:"}
axes:
  pan:   {min: -170, max: 170, velocity: 20, acceleration: 60, jerk: 300}   # and so does this one
  tilt:  {min: -56, max: 60, velocity: 20, acceleration: 60, jerk: 300}
  roll:  {min: -30, max: 30, velocity: 15, acceleration: 30, jerk: 150}
  focus: {min: 0, max: 1, velocity: 0.5, acceleration: 2, jerk: 10}
sinks:
  - {type: gimbal, link: gimbal, mode: position, rate: 50, simulated: SIMULATED}   # see above
  - {type: focus, link: gimbal, rate: 50}
  - {type: camera, link: gimbal}
"""


def check(variant: Variant, bench: CommissionBench) -> None:
    """That the profile is right, the axes are where they began, and nothing is in force."""
    made, section = bench.profile, bench.section
    refused, free = set(variant.refuses), [axis for axis in AXES if axis != variant.held]
    by_speed = "speed" not in refused and not variant.ignores_speed
    mode = "position" if "position" not in refused else "speed" if by_speed else "stick"
    assert section.mode == mode
    wiring = section.wiring
    for axis in free:
        index = AXES.index(axis)
        name = next(each for each in wiring.axes if each == axis)
        assert name is not None
        if mode == "position":
            assert wiring.sign(name) == variant.signs[index], f"sign of {axis}"
        if by_speed or mode == "stick":
            assert wiring.speed_sign(name) == variant.speed_signs[index], f"speed sign of {axis}"
        assert wiring.report_sign(name) == variant.report_signs[index], f"report sign of {axis}"
    exchanged = variant.order == ORDERS[2] or (variant.order == ORDERS[1] and variant.replies != "new")
    if variant.silent_angles or mode != "position" or variant.held in ("roll", "tilt"):
        exchanged = exchanged and section.legacy_angles != ORDERS[0]
    known = section.legacy_angles == ORDERS[2] or (section.legacy_angles == ORDERS[1] and variant.replies != "new")
    assert known == exchanged, section.legacy_angles
    assert ("focus" in [sink.type for sink in made.sinks]) == (variant.focus_motor != "absent")
    assert (section.mount.yaw % 360) == pytest.approx(variant.mount % 360, abs=1.0)
    text = bench.file.file.read_text()
    assert "this comment stays" in text
    assert "and so does this one" in text
    assert "# see above" in text
    assert bench.gimbal.angles == pytest.approx(bench.began, abs=0.45)
    assert not bench.gimbal.controlled
    assert max(map(abs, bench.gimbal.rates)) < 1e-3


SIGNS = st.tuples(*[st.sampled_from([1, -1])] * 3)
VARIANTS = st.builds(
    Variant,
    signs=SIGNS,
    speed_signs=SIGNS,
    report_signs=SIGNS,
    replies=st.sampled_from(["new", "bare", "legacy"]),
    order=st.sampled_from(ORDERS),
    refuses=st.sampled_from([(), (), ("position",), ("speed",), ("mode",)]),
    ignores_speed=st.booleans(),
    silent_pushes=st.booleans(),
    focus_motor=st.sampled_from(["calibrated", "uncalibrated", "absent"]),
    drift=st.sampled_from([0.0, 0.0, 0.3, -0.6]),
    lag=st.sampled_from([0.02, 0.05, 0.12]),
    dead_time=st.sampled_from([0.0, 0.04, 0.09]),
    mount=st.sampled_from([0.0, 180.0]),
    held=st.sampled_from(["", "", "pan", "roll", "tilt"]),
    bus_errors=st.sampled_from([0.0, 0.0, 0.02]),
    reset=st.sampled_from([0.0, 0.0, 17.0, 60.0]),
).filter(lambda variant: not variant.drift or "position" not in variant.refuses)
"""Without positions nothing brings back an axis that drifts, until its own sign of a speed is known."""
