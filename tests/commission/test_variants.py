"""The right profile comes out of each variant of the known unknowns, whichever come together."""

from __future__ import annotations

from pathlib import Path

import pytest
from commission_variants import ORDERS, Variant, check
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

ONE_BY_ONE = {
    "as documented": Variant(),
    "every sign otherwise": Variant((-1, 1, -1), (1, -1, -1), (-1, -1, 1)),
    "legacy replies, exchanged": Variant(replies="legacy", order="yaw-pitch-roll"),
    "bare replies": Variant(replies="bare"),
    "exchanged in every reply": Variant(order="all-yaw-pitch-roll", signs=(1, -1, 1), report_signs=(1, -1, 1)),
    "silent pushes": Variant(silent_pushes=True),
    "no answer to questions for angles": Variant(silent_angles=True),
    "positions refused": Variant(refuses=("position",), report_signs=(-1, 1, 1)),
    "only the joystick": Variant(refuses=("position",), ignores_speed=True, speed_signs=(1, 1, -1)),
    "follow modes refused": Variant(refuses=("mode",)),
    "no focus motor": Variant(focus_motor="absent"),
    "drift": Variant(drift=0.5, lag=0.12, dead_time=0.04),
    "a blocked axis": Variant(held="roll"),
    "mounted turned round": Variant(mount=180.0, boot=(10.0, 0.0, -5.0)),
    "an adapter that resets": Variant(reset=31.3),
    "a bus that is not terminated": Variant(bus_errors=0.05),
}
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
)


@pytest.mark.parametrize("variant", ONE_BY_ONE.values(), ids=ONE_BY_ONE)
def test_the_right_profile_comes_out_of_a_variant(variant: Variant, tmp_path: Path) -> None:
    bench = variant.bench(tmp_path)
    bench.run()
    check(variant, bench)


@settings(max_examples=2, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True)
@given(variant=VARIANTS)
def test_the_right_profile_comes_out_of_any_combination(variant: Variant, tmp_path_factory: pytest.TempPathFactory):
    bench = variant.bench(tmp_path_factory.mktemp("rig"))
    bench.run()
    check(variant, bench)
