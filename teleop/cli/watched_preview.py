"""`teleop preview --watch`: a page that is written again whenever one of its files is saved.

A page from a file may load a script but read no file. So beside the page is a script of one line with the version of
the page, and what is wrong with the sequence now; the page asks for it again and again (`plots/web/watch.js`). It goes
when the watch ends, and the page is then written without it.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from secrets import token_hex
from typing import TYPE_CHECKING

from teleop.app.planning import is_take
from teleop.cli.options import Options
from teleop.cli.screens.folded import complain, tell
from teleop.config.documents.document import DocumentError
from teleop.config.files import write_text
from teleop.config.resources import folder, is_bare

if TYPE_CHECKING:
    from teleop.plots.page import Watch

EVERY = 0.2  # s from one look at the files to the next
LARGEST = 20_000_000  # bytes: what is larger is no sequence, profile or table

Stamp = dict[Path, tuple[int, int]]


def watch_preview(file: str, options: Options, output: Path, write: Callable[[Watch | None], None]) -> int:
    """Write the page, and again after each change, until Ctrl-C; then once more, as one that is not watched."""
    beside = output.with_name(f"{output.name}.js")
    looked: Stamp | None = None
    version = ""
    tell(f"Watching {file}: open {output} in a browser. Ctrl-C ends.")
    try:
        while True:
            now = dict(_stamps(file, options.rig, {output.resolve(), beside.resolve()}))
            if now != looked:
                looked = now
                version = _written(beside, write, version)
            time.sleep(EVERY)
    except KeyboardInterrupt:
        return 0
    finally:
        beside.unlink(missing_ok=True)
        if version:
            with suppress(DocumentError):  # it was shown when it was found
                write(None)


def _written(beside: Path, write: Callable[[Watch | None], None], version: str) -> str:
    """The version that the page has now: a new one, or where the sequence has mistakes the one before."""
    from teleop.plots.page import Watch

    new, problems = token_hex(8), list[str]()
    try:
        write(Watch(new, beside.name))
    except DocumentError as error:
        problems = error.problems
        for problem in problems:
            complain(problem)
    else:
        version = new
    if version:
        write_text(beside, f"teleopPreview({json.dumps(version)}, {json.dumps(problems)});\n")
    return version


def _stamps(file: str, rig: str, but: set[Path]) -> Iterator[tuple[Path, tuple[int, int]]]:
    """When the files that the sequence may be made of were saved last, and their sizes: those of its folder, and of
    the rig's."""
    for place in _folders([file, rig]):
        with suppress(OSError):
            for each in sorted(place.iterdir()):
                with suppress(OSError):
                    found = each.stat()
                    if each.is_file() and each.resolve() not in but and found.st_size <= LARGEST:
                        yield each, (found.st_mtime_ns, found.st_size)


def _folders(names: Sequence[str]) -> Iterator[Path]:
    for name, kind in zip(names, ("sequences", "profiles"), strict=True):
        yield folder(kind) if is_bare(name) and not is_take(name) else Path(name).expanduser().parent
