"""`teleop take export FILE --csv OUT` and `take recover FILE`: other files made of a take."""

from __future__ import annotations

import json
from io import TextIOWrapper
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from teleop.cli.options import announce, announce_json
from teleop.cli.screens.folded import tell
from teleop.cli.take.options import Json, Overwrite, TakeFile, length, notify, place, problems_as_json
from teleop.config.files import replacing
from teleop.core.errors import UsageError
from teleop.recording import ENDING

COLUMNS = (
    "Columns: time (s); of each axis, as of pan, pan_stick (-1..1), pan_wish (cruise, goto, follow or halt), pan_asked"
    " (its number: unit/s of a cruise, else units), pan, pan_velocity, pan_acceleration (commanded), pan_measured and"
    " pan_measured_time (since the row before); actions. Empty where there was nothing."
)


def take_export(
    file: TakeFile,
    /,
    *,
    csv: Annotated[Path, Parameter(metavar="FILE", help=f"The table to write, a row for each tick. {COLUMNS}")],
    overwrite: Overwrite = False,
    as_json: Json = False,
) -> int:
    """Write a take as a table, a row for each tick; `teleop.recording.table` says what its columns are."""
    from teleop.recording.table import write_table

    place("--csv", csv, overwrite, file)
    with problems_as_json(as_json), replacing(csv) as stream:
        text = TextIOWrapper(stream, "utf-8", newline="", write_through=True)
        messages, rows = write_table(file, text)
        text.detach()
    notify(messages.remark)
    if as_json:
        announce_json({"ok": True, "written": str(csv), "rows": rows, "problem": messages.remark}, csv)
    else:
        announce(f"{csv}: {rows} rows", csv)
    return 0


def take_recover(
    file: TakeFile,
    /,
    *,
    output: Annotated[
        Path | None,
        Parameter(name=("--output", "-o"), metavar="FILE", help="The new file; else FILE-recovered.mcap beside it."),
    ] = None,
    overwrite: Overwrite = False,
    as_json: Json = False,
) -> int:
    """Save the whole part of a take that was cut off into a new file; the original is not changed.

    After a crash, kill -9, a full disk or a power cut a take has no end and no index; other programs refuse it.
    """
    from teleop.recording.recover import is_sound, recover

    target = output or file.with_name(f"{file.stem}-recovered{ENDING}")
    if target.suffix.lower() != ENDING:
        raise UsageError(f"-o {target}: its ending must be {ENDING}")
    place("-o", target, overwrite, file)
    with problems_as_json(as_json):
        if is_sound(file):
            if as_json:
                print(json.dumps({"ok": True, "written": None, "messages": 0}))
            else:
                tell(f"{file}: is complete; nothing to recover")
            return 0
        with replacing(target) as stream:
            saved = recover(file, stream)
    if as_json:
        counts = {"messages": saved.messages, "ticks": saved.ticks, "seconds": round(saved.seconds, 3)}
        print(json.dumps({"ok": True, "written": str(target), **counts, "bytes_lost": saved.lost}))
        return 0
    tell(f"{target}: saved {saved.messages} messages, {length(saved.seconds)}")
    if saved.lost:
        tell(f"lost: the last {saved.lost} of {saved.size} bytes, which are damaged, and what was never written")
    else:
        tell("lost: only what was never written")
    return 0
