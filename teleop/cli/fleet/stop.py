"""`teleop fleet stop`: STOP for several rigs."""

from __future__ import annotations

import json
from typing import Annotated

from cyclopts import Parameter

from teleop.cli.fleet.options import DEFAULTS, FleetOptions
from teleop.cli.screens.folded import complain, tell
from teleop.core.errors import UsageError


def fleet_stop(
    *names: Annotated[str, Parameter(metavar="NAME", help="The rigs; without a name, all of them.")],
    every: Annotated[
        bool, Parameter(name="--all", help="All rigs, also without names.", negative=(), show_default=False)
    ] = False,
    options: FleetOptions = DEFAULTS,
) -> int:
    """STOP rigs. It is repeated until the state of each shows it; those that do not show it are named."""
    from teleop.studio.stopping import stop_rigs

    if every and names:
        raise UsageError("--all: not together with names of rigs")
    with options.fleet(wait=False) as fleet:
        stopped, missed = stop_rigs(fleet, names or None)
        problems = fleet.problems
    if options.json:
        print(json.dumps({"ok": not missed and bool(stopped), "stopped": stopped, "not_reached": missed}))
    else:
        for name in stopped:
            tell(f"{name}: stopped")
        for name in missed:
            what = "no rig answers there" if "/" in name else "its state does not show the STOP"
            complain(f"teleop: {name} NOT REACHED: {what}; switch it off")
    for problem in problems:
        complain(f"teleop: {problem}")
    if not stopped and not missed:
        raise UsageError("no rig is there to stop")
    return 1 if missed else 0
