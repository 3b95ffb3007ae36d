"""`teleop take list [FOLDER]` and `teleop take info FILE`: which takes there are, and what is in one."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

from teleop.cli.screens.folded import tell
from teleop.cli.take.options import Json, TakeFile, ending_facts, length, notify, problems_as_json, recorded_on
from teleop.recording.format import LIMITS
from teleop.recording.summary import Summary, summarize, takes_in


def take_list(
    folder: Annotated[Path, Parameter(help="Where to look, not below it.")] = Path("."), /, *, as_json: Json = False
) -> int:
    """List the takes of a folder: what was played on which rig, when, how long, and how it ended.

    Of a take that was closed only the index is read; `take info` reads all of it.
    """
    with problems_as_json(as_json):
        found = list(takes_in(folder))
    if as_json:
        print(json.dumps({"ok": True, "takes": [_entry(file, what) for file, what in found]}))
    elif not found:
        tell(f"no takes (.mcap) in {folder}")
    else:
        _table(found)
    return 0


def take_info(file: TakeFile, /, *, as_json: Json = False) -> int:
    """Show what is in a take: the run, its axes and limits, messages by topic, actions, how it ended."""
    with problems_as_json(as_json):
        found = summarize(file)
    notify(found.remark)
    links = {} if found.ending is None else found.ending.links
    if as_json:
        axes = {
            axis.value: {name: _finite(getattr(of_axis, name)) for name in LIMITS}
            for axis, of_axis in found.about.limits.items()
        }
        actions = [{"time": round(time, 3), **action} for time, action in found.actions]
        rest = {"axes": axes, "messages": dict(found.counts), "actions": actions, "links": links}
        print(json.dumps({"ok": True, **_entry(file, found), "version": found.about.version, **rest}))
    else:
        tell("\n".join(_lines(found)))
    return 0


def _entry(file: Path, found: Summary | str) -> Mapping[str, Any]:
    if isinstance(found, str):
        return {"file": str(file), "damaged": True, "problem": found}
    about = found.about
    of_run = {"title": about.title, "rig": about.rig, "started": recorded_on(about.started)}
    of_file = {"damaged": bool(found.remark), "problem": found.remark, "bytes_lost": found.lost}
    return {"file": str(file), **of_run, "seconds": round(found.seconds, 3), **ending_facts(found.ending), **of_file}


def _table(found: list[tuple[Path, Summary | str]]) -> None:
    from teleop.cli.screens.tables import print_table

    rows = []
    for file, what in found:
        if isinstance(what, str):
            row = [file.name, "", "", "", "", "damaged"]
        else:
            when = recorded_on(what.about.started)[:16]
            ended = "damaged" if what.remark else str(what.ending)
            row = [file.name, what.about.title, what.about.rig, when, length(what.seconds), ended]
        rows.append(row)
    headings = ("Take", "Title", "Rig", "Recorded", "Length", "Ended")
    print_table("", headings, rows, words=[each for each in headings if each != "Length"], drop=("Rig", "Title"))
    for file, what in found:
        if isinstance(what, str):
            tell(f"{file}: {what}")
        elif what.remark:
            tell(what.remark)


def _lines(found: Summary) -> Iterator[str]:
    about, ending = found.about, found.ending
    yield f"{found.path}: {about.title} on {about.rig}, {length(found.seconds)}"
    yield f"recorded  {recorded_on(about.started)} by teleop {about.version}"
    yield f"ended     {'cut off: the file does not say how' if ending is None else ending}"
    if ending is not None and ending.dropped:
        yield f"dropped   {ending.dropped} ticks were not recorded"
    if found.lost:
        yield f"lost      {found.lost} bytes at the end are damaged"
    for axis, limits in about.limits.items():
        room = "continuous" if limits.continuous else f"{limits.minimum:g} .. {limits.maximum:g}"
        yield f"{axis:<9} {room}, {limits.velocity:g}/s, {limits.acceleration:g}/s2, {limits.jerk:g}/s3"
    yield f"messages  {', '.join(f'{topic} {count}' for topic, count in found.counts.items())}"
    done = Counter(action["action"] for _, action in found.actions)
    yield f"actions   {', '.join(f'{action} {count}' for action, count in done.items()) or 'none'}"
    for name, counts in ({} if ending is None else ending.links).items():
        yield f"link      {name}: {', '.join(f'{count} {word}' for word, count in counts.items() if count)}"


def _finite(limit: float) -> float | None:
    return limit if math.isfinite(limit) else None
