"""The two clocks: absolute, never backwards."""

import time

from hypothesis import given
from hypothesis import strategies as st

from teleop.core.clock import SystemClock, VirtualClock


@given(st.lists(st.floats(-1e6, 1e6), max_size=20))
def test_virtual_time_passes_only_forwards(times: list[float]) -> None:
    clock = VirtualClock(0.0)
    for moment in times:
        before = clock.now()
        clock.sleep_until(moment)
        assert clock.now() == max(before, moment)


def test_the_system_clock_sleeps_to_a_moment_and_not_for_a_moment_that_has_passed() -> None:
    clock = SystemClock()
    begun = clock.now()
    clock.sleep_until(begun - 1000)
    clock.sleep_until(begun + 0.02)
    assert clock.now() >= begun + 0.02
    assert clock.now() <= time.monotonic()
