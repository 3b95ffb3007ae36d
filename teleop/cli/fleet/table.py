"""`teleop fleet`: the table of all rigs, live or once."""

from __future__ import annotations

import json
from time import monotonic, sleep
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from teleop.cli.fleet.options import DEFAULTS, FleetOptions

if TYPE_CHECKING:
    from teleop.studio.fleet import Fleet

EVERY = 0.1  # s between two pictures of the table
EVERY_LINE = 1.0  # s between two lines of --json
CLOCKS_EVERY = 2.0  # s between two looks at the clocks


def fleet_table(
    *,
    once: Annotated[bool, Parameter(help="Print it once and end.", negative=(), show_default=False)] = False,
    options: FleetOptions = DEFAULTS,
) -> int:
    """Show all rigs: state, holder of control, move, error, age of the link, battery, offset of the clock."""
    with options.fleet() as fleet:
        fleet.measure_clocks()
        if once:
            _print(fleet, options.json)
            return 0
        return _lines(fleet) if options.json else _live(fleet)


def _print(fleet: Fleet, as_json: bool) -> None:
    if as_json:
        print(json.dumps({"rigs": [rig.as_json() for rig in fleet.rigs]}), flush=True)
        return
    from rich.console import Console

    from teleop.cli.screens.fleet_rows import fleet_table as drawn

    Console().print(drawn(fleet.rigs))
    for problem in fleet.problems:
        Console(stderr=True).print(f"teleop: {problem}", markup=False, highlight=False)


def _lines(fleet: Fleet) -> int:
    """A line a second, until it is interrupted."""
    while True:
        _print(fleet, True)
        sleep(EVERY_LINE)
        fleet.measure_clocks()


def _live(fleet: Fleet) -> int:
    from rich.live import Live

    from teleop.cli.screens.fleet_rows import fleet_table as drawn

    measured = monotonic()
    with Live(drawn(fleet.rigs, fleet.problems), auto_refresh=False, screen=False) as live:
        while True:
            sleep(EVERY)
            if monotonic() - measured > CLOCKS_EVERY:
                measured = monotonic()
                fleet.measure_clocks()
            live.update(drawn(fleet.rigs, fleet.problems), refresh=True)
