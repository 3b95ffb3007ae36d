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
    from teleop.studio.stopping import stop

    if every and names:
        raise UsageError("--all: not together with names of rigs")
    with options.fleet() as fleet:
        known = {rig.name for rig in fleet.rigs}
        unknown = [name for name in dict.fromkeys(names) if name not in known]
        asked = [name for name in dict.fromkeys(names) if name in known] if names else None
        chosen = [rig.name for rig in fleet.rigs if not rig.ended] if asked is None else asked
        missed = stop(fleet, asked)
        problems = fleet.problems
    stopped = [name for name in chosen if name not in missed]
    missed += unknown
    if options.json:
        print(json.dumps({"ok": not missed and bool(stopped), "stopped": stopped, "not_reached": missed}))
    else:
        for name in stopped:
            tell(f"{name}: stopped")
        for name in missed:
            complain(f"teleop: {name} NOT REACHED: its state does not show the STOP; switch it off")
    if not chosen and not missed:
        raise UsageError("; ".join(["no rig is there to stop", *problems]))
    return 1 if missed else 0
