"""`teleop take recover FILE`: other files made of a take."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from teleop.cli.take_options import Json, Overwrite, TakeFile, length, place, problems_said
from teleop.ports import UsageError
from teleop.preview.output import replacing
from teleop.sinks.recorder import ENDING


def take_recover(
    file: TakeFile,
    /,
    *,
    output: Annotated[
        Path | None, Parameter(name=("--output", "-o"), help="The new file; else FILE-recovered.mcap beside it.")
    ] = None,
    overwrite: Overwrite = False,
    as_json: Json = False,
) -> int:
    """Save what is whole of a take that was never closed, into a new file; the original stays as it is.

    After a crash, kill -9, a full disk or a power cut a take has no end and no index, and other programs refuse it.
    """
    from teleop.takes.recover import is_sound, recover

    target = output or file.with_name(f"{file.stem}-recovered{ENDING}")
    if target.suffix.lower() != ENDING:
        raise UsageError(f"-o {target}: its ending must be {ENDING}")
    place("-o", target, overwrite, file)
    with problems_said(as_json):
        if is_sound(file):
            if as_json:
                print(json.dumps({"ok": True, "written": None, "messages": 0}))
            else:
                print(f"{file}: is whole; there is nothing to recover")
            return 0
        with replacing(target) as stream:
            saved = recover(file, stream)
    if as_json:
        counts = {"messages": saved.messages, "ticks": saved.ticks, "seconds": round(saved.seconds, 3)}
        print(json.dumps({"ok": True, "written": str(target), **counts, "bytes_lost": saved.lost}))
        return 0
    print(f"{target}: saved {saved.messages} messages, {length(saved.seconds)}")
    if saved.lost:
        print(f"lost: the last {saved.lost} of {saved.size} bytes, which are not whole, and what was never written")
    else:
        print("lost: only what was never written")
    return 0
