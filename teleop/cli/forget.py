"""`teleop forget`: clears what is kept of how the axes of a rig answer."""

from __future__ import annotations

import json
from typing import Annotated

from cyclopts import Parameter

from teleop.cli.options import RIGS
from teleop.cli.screens.folded import tell
from teleop.cli.screens.response_lines import kept_facts, key_words
from teleop.config.documents.document import DocumentError
from teleop.config.profile import load_profile
from teleop.config.response_store import ResponseStore, default_folder
from teleop.core.errors import UsageError


def forget(
    *,
    rig: Annotated[
        str | None,
        Parameter(metavar="NAME|FILE", help="Only of this rig: a profile, or the name in it.", completer=RIGS),
    ] = None,
    everything: Annotated[
        bool, Parameter(name="--all", help="Of every rig, as without --rig.", negative=(), show_default=False)
    ] = False,
    as_json: Annotated[
        bool, Parameter(name="--json", help="Print JSON, for programs.", negative=(), show_default=False)
    ] = False,
) -> int:
    """Clear what was found of how the axes answer, and kept for later runs."""
    if rig is not None and everything:
        raise UsageError("--all: clears every rig: leave out --rig, or --all")
    store = ResponseStore(default_folder())
    kept = store.read()
    name = None if rig is None else _name(rig, store)
    cleared = [each for each in kept if name in (None, each.key.rig)]
    files = store.forget(name)
    damaged = [path for path in files if path in store.damaged]
    if as_json:
        print(json.dumps({"cleared": [*map(kept_facts, cleared)], "damaged": [*map(str, damaged)]}))
        return 0
    for each in cleared:
        tell(f"cleared: {each.key.rig}, {key_words(each.key)}: {each.axis}")
    for path in damaged:
        tell(f"cleared: {path}, which was damaged")
    if not files:
        tell("nothing is kept" if name is None else f"nothing is kept of {name}")
    return 0


def _name(rig: str, store: ResponseStore) -> str:
    """The name in a profile; or `rig` itself, where something is kept under that name. Raises DocumentError."""
    try:
        return load_profile(rig).name
    except DocumentError:
        if store.holds(rig):
            return rig
        raise
