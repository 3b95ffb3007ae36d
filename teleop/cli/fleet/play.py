"""`teleop fleet play`: one move for each of several rigs, from one moment on."""

from __future__ import annotations

import json
import re
import time
from collections.abc import Callable, Sequence
from datetime import datetime, timedelta
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from teleop.cli.fleet.options import DEFAULTS, FleetOptions
from teleop.cli.screens.folded import complain, tell
from teleop.core.errors import UsageError

if TYPE_CHECKING:
    from teleop.studio.common_start import CommonStart, SentMove
    from teleop.studio.fleet import Fleet

_NOW = re.compile(r"now(?:\+(\d+(?:\.\d+)?)\s?(s|m|min)?)?")
_DAY = re.compile(r"([01]?\d|2[0-3]):([0-5]\d)(?::([0-5]\d(?:\.\d+)?))?")
ALIVE_EVERY = 0.4  # s between two words of an operator who attends


def fleet_play(
    *moves: Annotated[str, Parameter(metavar="NAME=FILE", help="A rig, and the move that it plays.")],
    at: Annotated[
        str, Parameter(metavar="TIME", help="The start: now+5s, counted once all rigs are ready, or 18:30:00.")
    ] = "now+5s",
    attended: Annotated[
        bool,
        Parameter(help="Stay connected; the moves pause when this command ends.", negative=(), show_default=False),
    ] = False,
    options: FleetOptions = DEFAULTS,
) -> int:
    """Play a move on each of several rigs, from one moment of their clocks on.

    Each rig plans its own move within its own limits and takes this command for the holder of control. Without
    --attended the moves go on by themselves once they are started.
    """
    from teleop.studio.common_start import FleetError, play

    sent, when = _moves(moves), start_time(at)
    with options.fleet() as fleet:
        try:
            found = play(fleet, sent, when, attended)
        except FleetError as error:
            for name, why in error.problems.items():
                complain(f"teleop: {name}: {why}")
            complain("teleop: no rig plays")
            if options.json:
                print(json.dumps({"ok": False, "problems": error.problems}))
            return 1
        _announce(found, attended, options.json)
        return _attend(fleet, list(sent), found) if attended else 0


def start_time(text: str) -> Callable[[], float]:
    """How far the start is when it is asked (s). Raises UsageError."""
    if found := _NOW.fullmatch(text.strip()):
        seconds = float(found[1] or 0) * (60 if (found[2] or "s").startswith("m") else 1)
        return lambda: seconds
    if found := _DAY.fullmatch(text.strip()):
        hours, minutes, seconds = int(found[1]), int(found[2]), float(found[3] or 0)

        def left() -> float:
            now = datetime.now()
            then = now.replace(hour=hours, minute=minutes, second=0, microsecond=0) + timedelta(seconds=seconds)
            return ((then if then > now else then + timedelta(days=1)) - now).total_seconds()

        return left
    raise UsageError(f"--at {text}: must be now+5s or a time of day, as in 18:30:00")


def _moves(pairs: Sequence[str]) -> dict[str, SentMove]:
    """Each rig with the text of its move. Raises UsageError and DocumentError."""
    from teleop.studio.common_start import SentMove

    if not pairs:
        raise UsageError("name a move for each rig, as in cam-a=wide.yaml")
    found: dict[str, SentMove] = {}
    for pair in pairs:
        name, equals, file = pair.partition("=")
        if not equals or not name or not file:
            raise UsageError(f"{pair}: write it as NAME=FILE, as in cam-a=wide.yaml")
        if name in found:
            raise UsageError(f"{name}: has two moves")
        found[name] = SentMove.read(file)
    return found


def _announce(found: CommonStart, attended: bool, as_json: bool) -> None:
    if as_json:
        rigs = [
            {"name": rig.name, "at": rig.at, "duration": rig.duration, "ease": rig.ease, "doubt_ms": rig.doubt * 1000}
            for rig in found.rigs
        ]
        print(json.dumps({"ok": True, "start": found.date, "attended": attended, "rigs": rigs}), flush=True)
        return
    for rig in found.rigs:
        tell(f"{rig.name}: accepted, {rig.duration:.1f} s, clock ±{rig.doubt * 1000:.1f} ms")
    begin = datetime.fromtimestamp(found.date).strftime("%H:%M:%S.%f")[:-3]
    how = (
        "attended: true: the moves pause when this command ends"
        if attended
        else ("attended: false: the moves go on by themselves; `teleop fleet stop` stops them")
    )
    tell(f"All start at {begin}, in {found.date - time.time():.1f} s. {how}")


def _attend(fleet: Fleet, names: Sequence[str], found: CommonStart) -> int:
    """Until every move is over; 1 where a rig was lost meanwhile or was stopped."""
    failed = dict.fromkeys(names, "")
    left = set(names)
    while left:
        fleet.measure_clocks(sorted(left))
        for name in sorted(left):
            rig = fleet.rig(name)
            if not rig.alive or rig.stopped:
                failed[name] = "is stopped" if rig.stopped else "is lost"
                left.discard(name)
            elif time.monotonic() > found.moment and not rig.state.get("move"):
                left.discard(name)
        time.sleep(ALIVE_EVERY)
    for name in [name for name in names if failed[name]]:
        complain(f"teleop: {name} {failed[name]}")
    return 1 if any(failed.values()) else 0
