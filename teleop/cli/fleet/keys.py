"""`teleop fleet keys`: certificates, keys and the access list."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from teleop.cli.screens.folded import tell
from teleop.config.exchange.zenoh import RIG_NAME
from teleop.core.errors import UsageError

if TYPE_CHECKING:
    from teleop.studio.credentials import Role


def _member(text: str) -> Parameter:
    return Parameter(metavar="NAME", help=text, negative=(), show_default=False, consume_multiple=False)


def fleet_keys(
    folder: Annotated[Path, Parameter(metavar="FOLDER", help="Folder of the fleet's keys; it may be new.")],
    *,
    rig: Annotated[tuple[str, ...], _member("A rig, which listens; may be repeated.")] = (),
    operator: Annotated[tuple[str, ...], _member("One who operates; may be repeated.")] = (),
    watcher: Annotated[tuple[str, ...], _member("One who watches and may press STOP; may be repeated.")] = (),
    router: Annotated[tuple[str, ...], _member("A router between networks; may be repeated.")] = (),
) -> int:
    """Make a certificate and a key for each member of a fleet, and the access list with their roles.

    The first time this founds the fleet: ca.key signs all its certificates, so it stays where it was made. Each member
    needs its own NAME.yaml, NAME.pem, NAME.key and ca.pem; rigs need access.yaml too, and routers NAME.router.json5,
    again after a change. Without members it only makes the files of routers anew, as after a change in access.yaml.
    """
    from teleop.studio.keys import ACCESS, AUTHORITY, KeyFolder

    named = [*rig, *operator, *watcher, *router]
    if not named and not (folder / ACCESS).exists():
        raise UsageError("name the members, as in --rig cam-a --operator anna")
    for name in named:
        if not re.fullmatch(RIG_NAME, name) or named.count(name) > 1:
            raise UsageError(f"{name}: must be a name of its own: letters, digits, `.`, `-` and `_`")
    keys = KeyFolder(folder)
    roles: dict[Role, tuple[str, ...]] = {"rig": rig, "operate": operator, "watch": watcher, "router": router}
    for role, names in roles.items():
        for name in names:
            tell(f"{keys.add(name, role, serves=role in ('rig', 'router'))}: {role}")
    for file in keys.write_routers():
        tell(f"{file}: copy it to the router, and start the router again")
    tell(f"{folder / ACCESS}: copy it to every rig. Keep {AUTHORITY}.key here: it signs for the fleet.")
    return 0
