import math

from hypothesis import given
from hypothesis import strategies as st

from teleop.sim.gimbal.pushes import WINDOW, Beat


@given(
    st.floats(-1e5, 1e5),
    st.sampled_from([0.01, 0.1, 1 / 30, 0.5, 1.0]),
    st.lists(st.floats(0.0, WINDOW - 0.001), max_size=40),
    st.sampled_from([3, 20, math.inf]),
)
def test_no_beat_is_missed_or_repeated_however_often_one_looks(
    start: float, period: float, waits: list[float], count: float
) -> None:
    often, once = Beat(start, period, count), Beat(start, period, count)
    now, heard = start, []
    for wait in waits:
        now += wait
        heard += often.due(now)
    assert heard == [start + beat * period for beat in range(1, len(heard) + 1)]
    assert all(moment <= now for moment in heard)
    assert len(heard) == count or start + (len(heard) + 1) * period > now
    assert once.due(now) == heard[-math.ceil(WINDOW / period) :]


def test_six_hours_unheard_leave_a_second_of_pushes() -> None:
    assert len(Beat(0.0, 0.1).due(21_600.0)) == 10
