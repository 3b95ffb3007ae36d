"""`teleop fleet`: the table of all rigs, live or once."""

from __future__ import annotations

import json
from functools import partial
from time import sleep
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from teleop.cli.fleet.options import DEFAULTS, FleetOptions
from teleop.cli.meanwhile import meanwhile
from teleop.cli.screens.folded import complain
from teleop.studio.rig_state import LOST

if TYPE_CHECKING:
    from threading import Event

    from teleop.studio.fleet import Fleet

EVERY = 0.1  # s between two pictures of the table
SOONEST = 0.02  # s between two pictures at least
EVERY_LINE = 1.0  # s between two lines of --json
CLOCKS_EVERY = 2.0  # s between two looks at the clocks


def fleet_table(
    *,
    once: Annotated[bool, Parameter(help="Print it once and end.", negative=(), show_default=False)] = False,
    options: FleetOptions = DEFAULTS,
) -> int:
    """Show all rigs: state, holder of control, move, error, age of the link, battery, offset of the clock."""
    with options.fleet() as fleet:
        if once:
            fleet.measure_clocks()
            _print(fleet, options.json)
            for problem in fleet.problems:
                complain(f"teleop: {problem}")
            return 0
        with meanwhile(partial(_look_at_clocks, fleet), "clocks"):
            return _lines(fleet) if options.json else _live(fleet)


def _look_at_clocks(fleet: Fleet, over: Event) -> None:
    """Beside the table: a rig that does not answer holds no picture up."""
    fleet.measure_clocks()
    while not over.wait(CLOCKS_EVERY):
        fleet.measure_clocks()


def _print(fleet: Fleet, as_json: bool) -> None:
    if as_json:
        print(json.dumps({"rigs": [rig.as_json() for rig in fleet.rigs]}), flush=True)
        return
    from rich.console import Console

    from teleop.cli.screens.fleet_rows import fleet_table as drawn

    Console().print(drawn(fleet.rigs))


def _lines(fleet: Fleet) -> int:
    """A line a second, until it is interrupted."""
    while True:
        _print(fleet, True)
        sleep(EVERY_LINE)


def _live(fleet: Fleet) -> int:
    from rich.live import Live

    from teleop.cli.screens.fleet_rows import FleetView

    with Live(FleetView(fleet.rigs, fleet.problems), auto_refresh=False, screen=False) as live:
        while True:
            sleep(_pause(fleet))
            live.update(FleetView(fleet.rigs, fleet.problems), refresh=True)


def _pause(fleet: Fleet) -> float:
    """s to the next picture: where a rig is silent, when it would be lost."""
    silence = max((rig.age or 0.0 for rig in fleet.rigs if rig.alive), default=0.0)
    return max(SOONEST, min(EVERY, LOST - silence))
