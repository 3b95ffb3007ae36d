"""One move on each of several rigs, begun at one moment: planned by each rig first, then given the moment by its clock.

Nothing moves before every rig has accepted its move. Then each gets the moment by its own clock, goes to the start of
its move, and begins there. If one refuses, none plays.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from time import monotonic
from typing import Any, Self

from teleop.config.documents.document import DocumentError
from teleop.config.resources import find
from teleop.core.errors import TeleopError, UsageError
from teleop.remote.moves import refuse_files
from teleop.studio.clocks import MOST_DOUBT, Offset
from teleop.studio.fleet import Fleet
from teleop.studio.wire import LARGEST_MOVE

PLANNING = 70.0  # s for a plan: the rig gives up before
SPARE = 0.3  # s for telling all rigs, and at rest before the start
MEASURING = 5.0  # s for clocks that are in doubt


class FleetError(TeleopError):
    """What a command could not do at some rigs: `problems` has a reason for each of them."""

    def __init__(self, problems: Mapping[str, str]) -> None:
        super().__init__("; ".join(f"{name}: {why}" for name, why in problems.items()))
        self.problems = problems


@dataclass(frozen=True)
class SentMove:
    """A move as text, called `title`."""

    title: str
    text: str

    @classmethod
    def read(cls, file: str) -> Self:
        """The text of a move in a file, or of a shipped one. Raises DocumentError and UsageError.

        What is no YAML is refused here, with its line, and a move that needs another file, which would not be sent.
        """
        place, _ = find(file, "sequences", "sequence")
        try:
            refuse_files(place)
        except DocumentError:
            raise
        except UsageError as error:
            raise UsageError(f"{file}: {error}") from None
        text = place.read_text(encoding="utf-8-sig")
        if len(text) > LARGEST_MOVE:
            raise UsageError(f"{file}: has more than {LARGEST_MOVE} characters, too many to send")
        return cls(re.sub(r"[^\w. -]", "_", place.stem).strip(". ")[:80] or "move", text)


@dataclass(frozen=True)
class Started:
    """A rig that will play: `at` is the start by its own loop, `doubt` of the clocks and `ease` in s."""

    name: str
    duration: float
    ease: float
    at: float
    doubt: float


@dataclass(frozen=True)
class CommonStart:
    """What was agreed: `date` is the start by the operator's wall clock, `moment` by its monotonic one."""

    date: float
    moment: float
    rigs: Sequence[Started]


def play(
    fleet: Fleet,
    moves: Mapping[str, SentMove],
    when: Callable[[], float],
    attended: bool = False,
    options: Mapping[str, Any] | None = None,
) -> CommonStart:
    """Play each rig's move from one moment on. `when` is asked, once all have accepted, how far the moment is (s).

    Raises FleetError with the rigs that cannot and why; then none plays.
    """
    held: set[str] = set()
    try:
        plans = _each(list(moves), lambda name: _accepted(fleet, name, moves[name], attended, options or {}, held))
        offsets = _each(list(moves), lambda name: _offset(fleet, name))
        moment = monotonic() + when()
        _refuse_haste(plans, moment)
        started = _each(list(moves), lambda name: _started(fleet, name, moment + offsets[name].loop))
    except FleetError:
        for name in moves.keys() & {rig.name for rig in fleet.rigs}:
            if name in held:  # a move that plays there, and is why it has refused, goes on
                fleet.command(name, {"do": "abort"}, 1.0)
            fleet.left(name)
        raise
    now = monotonic()
    rigs = [
        Started(name, plans[name]["duration"], plans[name]["ease"], at, offsets[name].doubt_at(now))
        for name, at in started.items()
    ]
    return CommonStart(time.time() + moment - now, moment, rigs)


def _each(names: Sequence[str], work: Callable[[str], Any]) -> dict[str, Any]:
    """What `work` returns for each name, side by side. Raises FleetError with all that went wrong."""
    found: dict[str, Any] = {}
    problems: dict[str, str] = {}

    def one(name: str) -> None:
        try:
            found[name] = work(name)
        except TeleopError as error:
            problems[name] = str(error)

    with ThreadPoolExecutor(len(names) or 1) as threads:
        list(threads.map(one, names))
    if problems:
        raise FleetError({name: problems[name] for name in names if name in problems})
    return {name: found[name] for name in names}


def _accepted(
    fleet: Fleet, name: str, move: SentMove, attended: bool, options: Mapping[str, Any], held: set[str]
) -> Mapping[str, Any]:
    """The rig's plan of its move: we have control of it, and it is one of those that have `held` the move."""
    rig = fleet.rig(name)
    if not rig.alive:
        raise TeleopError("is not there")
    _good(fleet.command(name, {"do": "take_control"}))
    playing = rig.state.get("move") or {}
    if playing.get("phase") == "paused":  # as a STOP has left it, and nothing of a fleet resumes it
        _good(fleet.command(name, {"do": "abort", "wait": True}))
    fleet.measure_clock(name)
    load = {"title": move.title, "text": move.text, "attended": attended, **options}
    answer = fleet.ask(name, "command/load", load, PLANNING)
    if "error" not in answer or answer.get("kind") == "lost":
        held.add(name)
    return _good(answer)


def _offset(fleet: Fleet, name: str) -> Offset:
    """Raises TeleopError where the clocks stay in doubt."""
    end = monotonic() + MEASURING
    while True:
        found = fleet.measure_clock(name)
        if found is not None and found.doubt_at(monotonic()) <= MOST_DOUBT:
            return found
        if monotonic() > end:
            known = "unknown" if found is None else f"in doubt by {found.doubt_at(monotonic()) * 1000:.1f} ms"
            raise TeleopError(
                f"its clock is {known}, and may be by {MOST_DOUBT * 1000:g} ms: use a better network, or PTP"
            )


def _refuse_haste(plans: Mapping[str, Mapping[str, Any]], moment: float) -> None:
    left = moment - monotonic()
    late = {
        name: f"needs {plan['ease'] + SPARE:.1f} s to its start, and {max(left, 0.0):.1f} s are left: a later --at"
        for name, plan in plans.items()
        if plan["ease"] + SPARE > left
    }
    if late:
        raise FleetError(late)


def _started(fleet: Fleet, name: str, at: float) -> float:
    _good(fleet.command(name, {"do": "start", "at": at}))
    return at


def _good(answer: Mapping[str, Any]) -> Mapping[str, Any]:
    """The answer of a rig that does it; raises TeleopError with why it does not."""
    if "error" in answer:
        raise TeleopError(str(answer["error"]))
    return answer
