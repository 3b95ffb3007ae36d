"""What stands around a move when it is performed: how it is begun, how often it is played, what follows it."""

from __future__ import annotations

import math
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Protocol

from teleop.planner.trajectory import Move
from teleop.sequence.common_start import CommonStart


class Trigger(Protocol):
    """Starts a move that is ready for it: the rig is in place and rests."""

    @property
    def again(self) -> bool:
        """Whether each pass waits for it, not only the first one."""
        ...

    def open(self, stack: ExitStack) -> None:
        """Listen for it until the stack is left. Raises TeleopError where that cannot be."""
        ...

    def arm(self, now: float) -> None:
        """From `now` on (s, the loop's clock) it counts, and nothing that came before.

        Raises DeviceError when it can no longer come.
        """
        ...

    def fired(self, now: float) -> bool:
        """Whether the move is to start; asked every tick while it is armed, so it never waits."""
        ...

    def waits_for(self, now: float) -> str:
        """What it waits for, in a few words."""
        ...


class Corrector(Protocol):
    """Has each pass play the move as the passes before it have taught."""

    def ended(self, number: int) -> None:
        """Pass `number` is over."""
        ...

    def next_move(self) -> Move | None:
        """What the next pass plays; None while that is being worked out. It begins where the move itself does."""
        ...


@dataclass(frozen=True)
class Cycle:
    """`preroll` is the rest in place before the start and `start_at` where in the move to begin, both in s.

    `passes` is how often it is played, inf for until it is stopped. Passes that are `compared` begin out of a hush in
    which nothing happens at all, so that what is sent and asked at a rate begins its rhythm with each of them.
    """

    preroll: float = 0.0
    start_at: float = 0.0
    passes: float = 1
    compared: bool = False
    back_to_one: bool = False
    trigger: Trigger | None = None
    corrector: Corrector | None = None

    @property
    def repeats(self) -> bool:
        return self.passes > 1

    @property
    def moment(self) -> float:
        """The moment (s, the loop's clock) that the trigger fires for; inf where it is not known ahead."""
        return self.trigger.at if isinstance(self.trigger, CommonStart) else math.inf

    @property
    def endless(self) -> bool:
        return math.isinf(self.passes)
