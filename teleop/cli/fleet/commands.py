"""`teleop fleet`: several rigs, watched and commanded together."""

from __future__ import annotations

from collections.abc import Mapping

from cyclopts import App

from teleop.cli.examples import examples
from teleop.cli.fleet.table import fleet_table

COMMANDS: Mapping[str, tuple[str, str]] = {
    "stop": ("teleop.cli.fleet.stop:fleet_stop", "STOP rigs, until the state of each shows it."),
    "play": ("teleop.cli.fleet.play:fleet_play", "Play a move on each of several rigs, from one moment on."),
    "sticks": ("teleop.cli.fleet.sticks:fleet_sticks", "Move a distant rig by the joystick or keys of this machine."),
    "keys": ("teleop.cli.fleet.keys:fleet_keys", "Make certificates, keys and the access list of a fleet."),
}

app = App(name="fleet", help="Watch and command several rigs.", help_epilogue=examples("fleet"))
app.default(fleet_table)
for _order, (_name, (_place, _help)) in enumerate(COMMANDS.items()):
    app.command(_place, name=_name, help=_help, sort_key=_order, help_epilogue=examples(f"fleet {_name}"))
