"""The right profile comes out of each variant of the known unknowns, whichever come together.

What a gimbal can be one by one, and many of the combinations, are in tests/benchmarks/commissioned_gimbals.py.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from pathlib import Path

import pytest
from commission_bench import CommissionBench
from commission_variants import VARIANTS, Variant, check
from hypothesis import HealthCheck, given, settings

from teleop.commission.page import Page, Stage
from teleop.core.axes import Axis

TOGETHER = {
    "legacy and exchanged, every sign otherwise, no focus motor, silent pushes, turned round": Variant(
        *((-1, 1, -1), (1, -1, -1), (-1, -1, 1), "legacy", "yaw-pitch-roll"),
        silent_pushes=True,
        focus_motor="absent",
        mount=180.0,
        boot=(1.0, 0.0, -5.0),  # its readings go across 180
    ),
    "positions refused": Variant(refuses=("position",), report_signs=(-1, 1, 1), lag=0.12),
    "only the joystick, the adapter resets": Variant(
        refuses=("position", "mode"), ignores_speed=True, speed_signs=(1, 1, -1), reset=31.3
    ),
    "drift, exchanged in every reply, a blocked axis, a bus that is not terminated": Variant(
        order="all-yaw-pitch-roll", signs=(1, 1, -1), report_signs=(1, 1, -1), held="roll", bus_errors=0.05, drift=0.4
    ),
}
SHORT = "settings", "latency", "follow", "soft", "camera", "stop", "pad", "position-under-speed"
"""Steps that say nothing about these variants."""


def brief(variant: Variant) -> Callable[[Page], bool]:
    """Skips also the joystick, where the profile does without it."""
    short = [*SHORT, *(["stick"] if "position" not in variant.refuses or not variant.ignores_speed else [])]
    return lambda page: page.key.startswith(tuple(short))


@pytest.mark.parametrize("variant", TOGETHER.values(), ids=TOGETHER)
def test_the_right_profile_comes_out_of_a_variant(variant: Variant, tmp_path: Path) -> None:
    bench = variant.bench(tmp_path)
    bench.operator.skips = brief(variant)
    bench.run()
    check(variant, bench)


@settings(
    max_examples=1,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
    derandomize=True,
)
@given(variant=VARIANTS)
def test_the_right_profile_comes_out_of_any_combination(variant: Variant, tmp_path_factory: pytest.TempPathFactory):
    bench = variant.bench(tmp_path_factory.mktemp("rig"))
    bench.operator.skips = brief(variant)
    bench.run()
    check(variant, bench)


def test_no_step_is_faster_or_further_than_it_says_and_killed_at_any_moment_nothing_moves_on(tmp_path: Path) -> None:
    """What the gimbal does alone, once nothing more is sent, is seen on a copy of it, twice a second."""
    bench = CommissionBench(tmp_path / "out.yaml")
    bench.operator.skips = lambda page: page.key in ("settings", "pad", "soft-limits-tilt", "soft-limits-roll")
    looked: set[str] = set()

    def watch() -> None:
        key, now = bench.runner.step.key, bench.clock.now()
        if key.startswith(("recenter", "soft")):  # these ask for more
            return
        assert max(map(abs, bench.gimbal.rates)) <= 5.0, key
        assert max(map(abs, bench.gimbal.angles)) <= 5.0, key
        often = 5 if key == "stop" else 50  # that step is short here
        if round(now * 100) % often == 0 and any(bench.gimbal.rates):
            alone = copy.deepcopy(bench.gimbal)
            alone.advance(now + 1.3)
            assert max(map(abs, alone.rates)) < 1e-3, key
            looked.add(key)

    bench.watch = watch
    findings = bench.run()
    assert {f"{kind}-{axis}" for kind in ("position", "speed", "stick") for axis in ("pan", "tilt")} <= looked
    assert "stop" in looked
    assert findings["stop.works"].found is True
    assert (bench.profile.limits[Axis.PAN].minimum, bench.profile.limits[Axis.PAN].maximum) == (-20, 30)
    assert bench.gimbal.angles == pytest.approx((0, 0, 0), abs=0.3)


def test_what_drifts_and_cannot_be_brought_back_does_not_wander_off(tmp_path: Path) -> None:
    """Its steps are refused, each with the reason, and no way back is tried again and again."""
    bench = Variant(refuses=("position",), ignores_speed=True, drift=-0.6).bench(tmp_path)
    bench.operator.skips = lambda page: not page.key.startswith(("ready", "position", "speed", "stick"))
    furthest: list[float] = []
    bench.watch = lambda: furthest.append(max(map(abs, bench.gimbal.angles)))
    bench.run()
    assert max(furthest) < 12
    assert any("turn it back by hand, then repeat this step" in trouble for trouble in bench.operator.troubles)
    assert not bench.gimbal.controlled


def test_a_camera_that_records_is_a_reason_not_to_begin(tmp_path: Path) -> None:
    bench = CommissionBench(tmp_path / "out.yaml")
    bench.gimbal._camera.recording = True
    bench.run()
    assert bench.runner.stage is Stage.OVER
    assert "the camera is recording" in bench.runner.reason
    assert not bench.gimbal.counts["gimbal.position"]
    assert not bench.file.file.exists()
