"""How fast a move is played, and in which direction: speed override, pause, resume, stepping from key to key.

What is asked for is not done at once: a change of speed has to be searched for (`planner.warp`), which takes
milliseconds. A thread does that, for a moment a little ahead; the control thread only takes over what has been found
in time, and where it came too late another is searched for. So until then the move goes on as it was, and every
instant of a change that is made has been checked before.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from dataclasses import replace

from teleop.core.axes import Axis, Limits, State
from teleop.core.timing import SAME_TIME
from teleop.planner.chasing import Reference, catch_up
from teleop.planner.keyframes.findings import PlanError
from teleop.planner.time_scaling import TimeScaling, at_most, change_rate, go_to, run_up, state_at, steady
from teleop.planner.trajectory import Move

AHEAD = 0.08  # s from asking for a change to its beginning; the search takes 9 ms (docs/explanation/planning.md, C)
LATER = 2.0  # times further ahead when it was found too late
WRITTEN = 1.0  # the speed that a move was written for
FASTEST = 2.0  # times the speed that a move was written for
CLOSE, SAME_RATE = 0.002, 1e-3  # s and s in a s by which a chase may be off
CHASE_AGAIN, REFUSED_AGAIN = 0.1, 0.5  # s between two changes of a chase, and after one that cannot be
ASK_AGAIN = 0.05  # s between two looks at a paused move

Search = Callable[[TimeScaling, float], TimeScaling]  # from the present pace, for a change at that time


class Playback:
    """A move's own time over the clock's, at `rate` from `begin` on; 1 is the speed that it was written for.

    `keys` are the move's times to step to, in s, rising. `start_at` is where in the move to begin (s): with a run-up,
    so that it is there with the speed that it has there. Changes are searched for by `executor`, a thread unless given.
    Raises PlanError where `rate` is more than the move allows. The speed that it was written for it always allows: a
    recording at the limits themselves leaves no headroom, and the maker of the move has checked every step of it.
    """

    def __init__(
        self,
        move: Move,
        limits: Mapping[Axis, Limits],
        rate: float = 1.0,
        keys: Sequence[float] = (),
        executor: Executor | None = None,
        start_at: float = 0.0,
    ) -> None:
        self._move, self._limits, self._keys, self._start_at = move, limits, keys, start_at
        self.at_most = min(at_most(move, limits), FASTEST)
        if rate != WRITTEN:
            allowed(rate, self.at_most)
        self._opened = self._opening(rate)
        self._pace = replace(self._opened, start=math.inf)
        self._resumed = rate  # what a pause ends with
        self._executor = executor or ThreadPoolExecutor(1, thread_name_prefix="warp")
        self._search: Search | None = None
        self._found: Future[TimeScaling] | None = None
        self._ahead = AHEAD
        self._read = -math.inf  # when it was last asked where the axes are
        self._chased = -math.inf  # when another change was asked for by `chase`
        self.refusal = ""  # of the last thing asked for, in a line

    def begin(self, now: float) -> None:
        """It starts at `now`; until then everything rests where `opening` is."""
        self._pace, self._read = replace(self._opened, start=now), now

    def replace(self, move: Move) -> None:
        """Play another move from the next beginning on, which rests where this one does then."""
        self._move = move
        self.at_most = min(at_most(move, self._limits), FASTEST)
        self._opened = self._opening(self._resumed)

    def rewind(self) -> None:
        """Get ready to begin again, at the speed that was chosen last; everything has to rest meanwhile."""
        self._search = self._found = None
        if self._resumed != self._opened.rate:
            self._opened = self._opening(self._resumed)

    @property
    def opening(self) -> float:
        """The move's time to stand at before it begins, in s."""
        return self._opened.coefficients[0]

    def _opening(self, rate: float) -> TimeScaling:
        """From the move's beginning, or in mid move with a run-up, which takes milliseconds to find."""
        if not self._start_at:
            return steady(self._move.opening, rate, 0.0)
        return run_up(self._move, self._limits, self._start_at, rate)

    def at(self, now: float) -> tuple[float, dict[Axis, State]]:
        """The move's time and where its axes are, at `now`; the control thread calls it every tick."""
        self._take_over(now)
        self._read = now
        return self._pace.at(now)[0], state_at(self._move, self._pace, now)

    def foreseen(self, time: float, begin: float | None = None) -> dict[Axis, State]:
        """Where the axes will be at a `time` soon, if nothing is asked for; `begin` is when a pass will start."""
        pace = self._pace if begin is None else replace(self._opened, start=begin)
        return state_at(self._move, pace, time)

    def time(self, now: float) -> float:
        """The move's own time at `now`, in s."""
        return self._pace.at(now)[0]

    def when(self, time: float, now: float) -> float:
        """When the move's own `time` will be reached as things are: inf for never, soon to ask again while paused."""
        here, rate, _ = self._pace.at(now)
        if math.isinf(time):
            return math.inf
        return now + (max(time - here, 0.0) / rate if rate > 0 else ASK_AGAIN)

    def rate(self, now: float) -> float:
        """How many seconds of the move go by in a second."""
        return self._pace.at(now)[1]

    def changing(self, now: float) -> bool:
        """Whether a change of speed is going on, or being searched for."""
        return self._search is not None or now < self._pace.start + self._pace.duration - SAME_TIME

    def speed(self, rate: float, now: float) -> None:
        """To `rate` (0..2, 1 is 100 %), now or after the pause."""
        try:
            allowed(rate, self.at_most)
        except PlanError as error:
            self.refusal = str(error)
            return
        paused, self._resumed = self.paused, rate
        if not paused:
            self._ask(lambda pace, start: change_rate(self._move, self._limits, pace, rate, start), now)

    @property
    def chosen(self) -> float:
        """The speed asked for last: what it plays at, will play at, or goes on at after a pause."""
        return self._resumed

    @property
    def paused(self) -> bool:
        return self._pace.rate == 0.0

    def pause(self, now: float) -> None:
        self._ask(lambda pace, start: change_rate(self._move, self._limits, pace, 0.0, start), now)

    def resume(self, now: float) -> None:
        rate = self._resumed = min(self._resumed, self.at_most)
        self._ask(lambda pace, start: change_rate(self._move, self._limits, pace, rate, start), now)

    def chase(self, reference: Reference, now: float) -> None:
        """Follow a clock that is not ours: another change where it is not near enough, once the last one is made.

        `refusal` says where the limits keep the move from following.
        """
        if self.changing(now) or now < self._chased + (REFUSED_AGAIN if self.refusal else CHASE_AGAIN):
            return
        self._chased = now
        here, rate, _ = self._pace.at(now)
        off = abs(reference.place(now) - here) > CLOSE or abs(reference.rate - rate) > SAME_RATE
        if not rate or off:
            self._ask(lambda pace, start: catch_up(self._move, self._limits, pace, reference, start), now)

    def hold(self, time: float, now: float) -> tuple[float, dict[Axis, State]]:
        """Stay at the move's `time`, where it rests, until `go`: as `at`. To stop at a rest takes no search."""
        self._search = self._found = None
        self._pace = steady(time, 0.0, now)
        return self.at(now)

    def freeze(self, now: float) -> None:
        """Stand still from `now` on at the place that was asked for last: the axes have been stopped off the path.

        They are to be brought back to it, at rest, before `resume`.
        """
        self._search = self._found = None
        self.refusal = ""
        self._pace = steady(self.time(min(now, self._read)), 0.0, now)

    def go(self, now: float) -> None:
        """On from where it was held, at once: from rest to rest no speed is too much of a change."""
        self._search = self._found = None
        self._pace = steady(self.time(now), self._resumed, now)

    def step(self, keys: int, now: float) -> None:
        """To the next key (1) or the one before (-1), along the path; the move has to be paused."""
        here = self._pace.at(now)[0]
        index = bisect_right(self._keys, here + 1e-3) if keys > 0 else bisect_left(self._keys, here - 1e-3) - 1
        if not 0 <= index < len(self._keys):
            self.refusal = f"no key {'after' if keys > 0 else 'before'} this one"
            return
        self.seek(self._keys[index], now)

    def seek(self, time: float, now: float) -> None:
        """To the move's `time`, along the path; the move has to be paused."""
        target = min(max(time, self._move.opening), self._move.duration)
        self._ask(lambda pace, start: go_to(self._move, self._limits, pace, target, start), now)

    def _ask(self, search: Search, now: float) -> None:
        self.refusal = ""
        self._search, self._ahead = search, AHEAD
        self._begin_search(now)

    def _begin_search(self, now: float) -> None:
        assert self._search is not None
        if self._found is not None:
            self._found.cancel()
        self._found = self._executor.submit(self._search, self._pace, now + self._ahead)

    def _take_over(self, now: float) -> None:
        if self._found is None or not self._found.done():
            return
        try:
            pace = self._found.result()
        except PlanError as error:
            self.refusal = str(error)
            self._search = self._found = None
            return
        if now < pace.start - SAME_TIME:
            return
        if self._read > pace.start + SAME_TIME:  # found after its beginning: the move has gone on at the old pace
            self._ahead *= LATER
            self._begin_search(now)
            return
        self._pace, self._search, self._found = pace, None, None


def fastest(move: Move, limits: Mapping[Axis, Limits]) -> float:
    """The highest speed at which `move` can be played; what it was written for is always possible."""
    return max(WRITTEN, min(at_most(move, limits), FASTEST))


def allowed(rate: float, most: float) -> None:
    """Raises PlanError when the move cannot be played at `rate`."""
    if not 0 <= rate <= most:
        raise PlanError(f"maximum playback speed: {math.floor(100 * most)} %, not {100 * rate:.0f} %")
