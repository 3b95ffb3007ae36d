"""Ruckig, one step at a time: the only module that handles its errors.

Ruckig raises RuckigError for most failures and ValueError for result -101 (docs/explanation/planning.md, "Ruckig
traps"). Here both become None, and the caller takes its next plan; the last one is the guard stop, which needs no
solver. Inputs are kept between calls, because handing Ruckig a list costs a tenth of a whole solution.
"""

from __future__ import annotations

from collections.abc import Sequence

from ruckig import ControlInterface, InputParameter, OutputParameter, Ruckig, RuckigError, Synchronization, Trajectory

from teleop.core.axes import State

REFUSALS = (RuckigError, ValueError)
new_state = tuple.__new__  # new_state(State, row) is State(*row) at two thirds of the cost


class VelocitySolver:
    """All axes towards their velocities, each on its own; as many axes as it is built for.

    Ruckig keeps its own state from tick to tick. States are set only where they are not those that it left, which
    halves the cost of a step.
    """

    def __init__(self, count: int) -> None:
        self._ruckig = Ruckig(count, 1.0)
        self._question = InputParameter(count)
        self._question.control_interface = ControlInterface.Velocity
        self._question.synchronization = Synchronization.No
        self._answer = OutputParameter(count)
        self._limits: list[tuple[float, float]] = []
        self._seconds = 0.0

    def place(self, states: Sequence[State]) -> None:
        """The axes are here, not where the last step left them."""
        columns = [list(column) for column in zip(*states, strict=True)]
        self._question.current_position, self._question.current_velocity, self._question.current_acceleration = columns

    def step(
        self, velocities: list[float], limits: list[tuple[float, float]], seconds: float
    ) -> tuple[list[float], list[float], list[float]] | None:
        """Positions, velocities and accelerations after `seconds`, or None and the axes stay where they were.

        `limits` are accelerations and jerks.
        """
        question, answer = self._question, self._answer
        if limits != self._limits:
            question.max_acceleration, question.max_jerk = (list(column) for column in zip(*limits, strict=True))
            self._limits = limits
        if seconds != self._seconds:
            self._ruckig.delta_time = self._seconds = seconds
        question.target_velocity = velocities
        try:
            self._ruckig.update(question, answer)
        except REFUSALS:
            return None
        answer.pass_to_input(question)
        return answer.new_position, answer.new_velocity, answer.new_acceleration


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
        try:
            self._ruckig.calculate(question, answer)
        except REFUSALS:
            return None
        return answer
