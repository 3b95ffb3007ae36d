"""`teleop check FILE`: whether a rig can play a sequence, without touching a port."""

from __future__ import annotations

import json
import math
from collections import Counter
from dataclasses import asdict
from typing import Annotated

from cyclopts import Parameter

from teleop.app.check import MoveCheck
from teleop.app.check import check as check_plan
from teleop.app.planning import Plan
from teleop.cli.check_verdict import refusal, verdict
from teleop.cli.options import DEFAULTS, MOVES, Options, print_warnings
from teleop.cli.screens.folded import tell
from teleop.cli.shipped_files import named
from teleop.config.documents.document import DocumentError


def check(
    file: Annotated[str | None, Parameter(help="A shipped move's name, or a file.", completer=MOVES)] = None,
    /,
    *,
    options: Options = DEFAULTS,
) -> int:
    """Check a sequence against a rig: every error with its line, or what the move asks of each axis."""
    file = named("check", file, options.json)
    try:
        plan = options.plan(file)
    except DocumentError as error:
        if not options.json:
            error.add_note(refusal(error, options))
        raise
    if plan.timelapse is not None:
        print_warnings(plan.sequence.warnings)
    found = check_plan(plan)
    if options.json:
        print(json.dumps(_facts(plan, found)))
        return 0
    _print_table(plan, found)
    if plan.timelapse is not None:
        from teleop.cli.shooting.timelapse_summary import summary

        tell(f"{summary(plan.timelapse)}. The table is of its rehearsal.")
    if counted := Counter(cue.name for cue in plan.sequence.cues):
        tell(f"Cues: {', '.join(f'{count} x {name}' if count > 1 else name for name, count in counted.items())}.")
    if plan.is_flown:
        tell("A drone's move is played at its own speed only.")
    else:
        tell(f"Maximum playback speed: {math.floor(100 * found.fastest)} %.")
    for line in verdict(plan, found):
        tell(line)
    return 0


def _facts(plan: Plan, found: MoveCheck) -> dict[str, object]:
    sequence = plan.sequence
    shoot: dict[str, object] = {}
    if plan.timelapse is not None:
        from teleop.cli.shooting.timelapse_summary import facts

        shoot["timelapse"] = facts(plan.timelapse)
    return {
        "ok": True,
        "title": sequence.title,
        "duration": sequence.duration,
        "axes": {axis.value: asdict(use) for axis, use in found.axes.items()},
        "cues": [{"at": cue.at, "name": cue.name} for cue in sequence.cues],
        "speed_at_most": found.fastest,
        "remarks": list(found.remarks),
        **({"frames": {axis.value: asdict(each) for axis, each in found.frames.items()}} if found.frames else {}),
        "warnings": list(sequence.warnings),
        **shoot,
    }


def _print_table(plan: Plan, found: MoveCheck) -> None:
    from teleop.cli.screens.tables import print_table

    rows = []
    for axis, use in found.axes.items():
        shares = [f"{share:.0%}" for share in (use.velocity, use.acceleration, use.jerk)]
        rows.append([axis.value, *shares, "continuous" if use.room is None else f"{use.room:.3g}"])
    title = f"{plan.sequence.title}: {plan.sequence.duration:.2f} s on {plan.profile.name}"
    print_table(
        title, ("Axis", "Velocity", "Acceleration", "Jerk", "Room"), rows, words=("Axis",), drop=("Room", "Jerk")
    )
