"""Ruckig, one step at a time, and the only place that meets its errors.

Ruckig reports trouble by raising, RuckigError for most and ValueError for result -101 (planning.md, "Ruckig traps").
Here both become None: the caller then takes the next plan of its ladder, at the end of which stands the guard stop.
Inputs are kept between calls because handing Ruckig a list costs a tenth of a whole solution.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ruckig import ControlInterface, InputParameter, OutputParameter, Ruckig, RuckigError, Synchronization, Trajectory

from teleop.motion import State

_new = tuple.__new__  # State(*row) at a third of the cost


class VelocitySolver:
    """All axes towards their velocities, each on its own; as many axes as it is built for.

    Ruckig carries its own state on from tick to tick; it is told where the axes are only when that is not where it
    left them, which halves the cost of a step.
    """

    def __init__(self, count: int) -> None:
        self._ruckig = Ruckig(count, 1.0)
        self._question = InputParameter(count)
        self._question.control_interface = ControlInterface.Velocity
        self._question.synchronization = Synchronization.No
        self._answer = OutputParameter(count)
        self._limits: list[tuple[float, float]] = []
        self._states: list[State] = []
        self._seconds = 0.0

    def step(
        self, states: list[State], velocities: list[float], limits: list[tuple[float, float]], seconds: float
    ) -> list[State] | None:
        """The states after `seconds`, or None. `limits` are accelerations and jerks."""
        question, answer = self._question, self._answer
        if states != self._states:
            columns = [list(column) for column in zip(*states, strict=True)]
            question.current_position, question.current_velocity, question.current_acceleration = columns
        if limits != self._limits:
            question.max_acceleration, question.max_jerk = (list(column) for column in zip(*limits, strict=True))
            self._limits = limits
        if seconds != self._seconds:
            self._ruckig.delta_time = self._seconds = seconds
        question.target_velocity = velocities
        if not _solved(self._ruckig.update, question, answer):
            self._states = []
            return None
        answer.pass_to_input(question)
        rows = zip(answer.new_position, answer.new_velocity, answer.new_acceleration, strict=True)
        self._states = [_new(State, row) for row in rows]
        return self._states


def _solved(solve: Callable[..., object], question: InputParameter, answer: OutputParameter | Trajectory) -> bool:
    try:
        solve(question, answer)
    except (RuckigError, ValueError):
        return False
    return True


class PositionSolver:
    """One or several axes to target states, arriving together."""

    def __init__(self, count: int = 1) -> None:
        self._ruckig = Ruckig(count)
        self._question = InputParameter(count)
        self._count = count

    def solve(
        self,
        start: Sequence[State],
        target: Sequence[State],
        velocity: Sequence[float],
        acceleration: Sequence[float],
        jerk: Sequence[float],
        *,
        minimum_duration: float | None = None,
        lowest_velocity: Sequence[float] | None = None,
        lowest_acceleration: Sequence[float] | None = None,
    ) -> Trajectory | None:
        """The fastest common trajectory that takes at least `minimum_duration` seconds, or None.

        Limits are magnitudes; `lowest_velocity` and `lowest_acceleration` say where downward ones differ.

        It may take longer even where the limits would not ask for it: look at its `duration`.
        """
        question = self._question
        question.current_position, question.current_velocity, question.current_acceleration = zip(*start, strict=True)
        question.target_position, question.target_velocity, question.target_acceleration = zip(*target, strict=True)
        question.max_velocity, question.max_acceleration, question.max_jerk = velocity, acceleration, jerk
        question.min_velocity, question.min_acceleration = lowest_velocity, lowest_acceleration
        question.minimum_duration = minimum_duration
        answer = Trajectory(self._count)
        return answer if _solved(self._ruckig.calculate, question, answer) else None
