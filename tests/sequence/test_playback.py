"""Speed override, pause, resume and stepping: on the path, within the limits, never searched in the control thread."""

import math
import threading
from concurrent.futures import Executor, ThreadPoolExecutor

import pytest
from at_once import AtOnce
from hypothesis import given, settings
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits, State
from teleop.core.setpoints import StateTarget
from teleop.planner.keyframes.findings import PlanError
from teleop.planner.keyframes.planner import Key, plan
from teleop.planner.live import Live
from teleop.sequence.playback import AHEAD, Playback

PAN, TILT = Axis.PAN, Axis.TILT
LIMITS = {PAN: Limits(-170, 170, 60, 120, 600), TILT: Limits(-30, 40, 40, 90, 480)}
KEYS = {PAN: [Key(0, 0), Key(4, 60), Key(7, 60, hold=1), Key(12, -40)], TILT: [Key(0, 0), Key(6, 30), Key(12, 0)]}
MOVE = plan(KEYS, LIMITS)
STOPS = [0.0, 4.0, 6.0, 7.0, 12.0]
DT = 0.01


class Show:
    """A playback, and the live planner that makes each of its states a legal step, tick by tick."""

    def __init__(self, rate: float = 1.0, executor: Executor | None = None) -> None:
        self.playback = Playback(MOVE, LIMITS, rate, STOPS, executor or AtOnce())
        self.playback.begin(10.0)
        self.now = 10.0
        self.live = Live(LIMITS, DT)
        self.live.reset({axis: State(0.0) for axis in LIMITS})
        self.behind = 0.0  # the farthest the planner's stream was from what the playback asked for

    def run(self, seconds: float) -> float:
        """On for so many seconds; the move's time then."""
        for _ in range(round(seconds / DT)):
            self.now += DT
            time, states = self.playback.at(self.now)
            motion = self.live.step({axis: StateTarget(*state) for axis, state in states.items()})
            for axis, state in states.items():
                path = MOVE.at(time)[axis].position
                assert state.position == pytest.approx(path, abs=1e-9)
                self.behind = max(self.behind, abs(motion[axis].position - state.position))
        return self.playback.time(self.now)


def test_a_move_plays_at_the_speed_asked_for_from_the_start():
    show = Show(1.2)
    assert show.run(5) == pytest.approx(6.0)
    assert show.behind < 1e-9


def test_more_than_the_move_allows_is_refused_with_what_it_does():
    with pytest.raises(PlanError) as refusal:
        Show(3.0)
    most = Show().playback.at_most
    assert str(refusal.value) == f"maximum playback speed: {math.floor(100 * most)} %, not 300 %"
    show = Show()
    show.playback.speed(3.0, show.now)
    assert show.playback.refusal == str(refusal.value)
    assert show.run(2) == pytest.approx(2.0)


def test_pause_resume_and_back_to_the_speed_that_was_chosen_meanwhile():
    show = Show()
    show.run(2)
    show.playback.pause(show.now)
    paused = show.run(3)
    assert show.playback.paused
    assert not show.playback.changing(show.now)
    assert show.run(5) == paused
    show.playback.speed(0.5, show.now)
    assert show.run(1) == paused
    show.playback.resume(show.now)
    show.run(3)
    before = show.run(0.01)
    assert show.run(2) - before == pytest.approx(1.0)
    assert show.behind < 1e-9


def test_steps_go_to_the_keys_on_either_side_and_stop_at_the_ends():
    show = Show()
    show.run(5)
    show.playback.pause(show.now)
    show.run(3)
    for keys, expected in ((1, 6.0), (1, 7.0), (-1, 6.0), (-1, 4.0), (-1, 0.0)):
        show.playback.step(keys, show.now)
        assert show.run(30) == pytest.approx(expected, abs=1e-9)
    show.playback.step(-1, show.now)
    assert show.playback.refusal == "no key before this one"
    assert show.behind < 1e-9


def test_a_step_while_the_move_runs_is_refused():
    show = Show()
    show.run(2)
    show.playback.step(1, show.now)
    show.run(1)
    assert show.playback.refusal == "the move is running: pause it before stepping to a key"
    assert show.playback.time(show.now) == pytest.approx(3.0)


def test_a_change_found_too_late_is_searched_for_again_and_the_move_goes_on_until_then():
    held = threading.Event()
    thread = ThreadPoolExecutor(1)

    class Slow(Executor):
        def submit(self, fn, /, *args, **kwargs):
            return thread.submit(lambda: (held.wait(30), fn(*args, **kwargs))[1])

    show = Show(executor=Slow())
    show.playback.pause(show.now)
    assert show.run(AHEAD + 1) == pytest.approx(AHEAD + 1)
    held.set()
    waited = 0
    while show.playback.changing(show.now) and waited < 1000:
        waited += 1
        thread.submit(int).result()  # whatever was being searched for has been found
        show.run(DT)
    assert show.playback.paused
    assert show.behind < 1e-9


ASKING = {
    "pause": lambda playback, now: playback.pause(now),
    "resume": lambda playback, now: playback.resume(now),
    "half": lambda playback, now: playback.speed(0.5, now),
    "full": lambda playback, now: playback.speed(1.0, now),
    "fast": lambda playback, now: playback.speed(playback.at_most, now),
    "next": lambda playback, now: playback.step(1, now),
    "previous": lambda playback, now: playback.step(-1, now),
}


@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(st.sampled_from(sorted(ASKING)), st.floats(0.05, 2.0)), min_size=1, max_size=6))
def test_whatever_is_asked_for_and_whenever_the_stream_is_the_path_within_limits(script):
    show = Show()
    show.run(1)
    for request, seconds in script:
        ASKING[request](show.playback, show.now)
        show.run(seconds)
    assert show.behind < 1e-6
