"""Whatever a pass has measured, the next one keeps V, A, J and the soft limits, through the real planner too."""

from __future__ import annotations

import numpy as np
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits, State
from teleop.core.setpoints import StateTarget
from teleop.learning.axis_learner import AxisLearner
from teleop.learning.correction import Error
from teleop.planner.keyframes.planner import Key, stretch
from teleop.planner.live import Live
from teleop.planner.offset_track import added
from teleop.recording.legality import excess

LIMITS = Limits(-30.0, 30.0, 60.0, 120.0, 600.0)


@settings(max_examples=8, deadline=None, phases=[Phase.generate], suppress_health_check=[HealthCheck.too_slow])
@given(
    places=st.lists(st.floats(-30, 30), min_size=2, max_size=4, unique=True),
    late=st.floats(-0.1, 0.4),
    gain=st.floats(0.5, 1.5),
    lunge=st.floats(-60, 60),
    lunge_at=st.floats(0, 2),
)
def test_a_learned_pass_is_legal_whatever_was_measured(
    places: list[float], late: float, gain: float, lunge: float, lunge_at: float
):
    keys = [Key(0.3 * number, place) for number, place in enumerate(places)]
    move, _ = stretch({Axis.PAN: keys}, {Axis.PAN: LIMITS}, 0.0)  # some limit is used whole
    track = move.tracks[Axis.PAN]
    times = np.arange(0, move.duration, 0.04)
    measured = gain * track.sample(times - late)[0] + lunge * np.exp(-(((times - lunge_at) / 0.1) ** 2))
    learner = AxisLearner(track, LIMITS, [-0.3, move.duration + 0.3], None)
    learner.learn(1, Error(len(times), 9.0, 9.0, 0.0), (times, measured))
    corrected = added(track, learner.offset)
    ticks = np.arange(-0.3, move.duration + 0.31, 0.01)
    states = corrected.sample(ticks)[:3]
    assert list(excess(ticks, states, LIMITS)) == []
    live = Live({Axis.PAN: LIMITS}, 0.01)
    live.reset({Axis.PAN: State(*states[:, 0].tolist())})
    for state in states.T.tolist()[1:]:
        assert live.step({Axis.PAN: StateTarget(*state)})[Axis.PAN].position == state[0]  # taken exactly, never bent
