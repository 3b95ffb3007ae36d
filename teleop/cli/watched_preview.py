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
from teleop.cli.signals import unwound_by_signals
from teleop.config.documents.document import DocumentError
from teleop.config.files import write_text
from teleop.config.files_read import Saved, files_read, saved
from teleop.config.resources import folder, is_bare

if TYPE_CHECKING:
    from teleop.plots.page import Watch

EVERY = 0.2  # s from one look at the files to the next
LARGEST = 20_000_000  # bytes: what is larger is no sequence, profile or table

Stamps = dict[Path, Saved | None]


def watch_preview(file: str, options: Options, output: Path, write: Callable[[Watch | None], None]) -> int:
    """Write the page, and again after each change, until Ctrl-C; then once more, as one that is not watched."""
    beside = output.with_name(f"{output.name}.js")
    looked: Stamps | None = None
    read: Stamps = {}
    version = ""
    tell(f"Watching {file}: open {output} in a browser. Ctrl-C ends.")
    with suppress(KeyboardInterrupt), unwound_by_signals():
        try:
            while True:
                folders = dict(_stamps(file, options.rig, {output.resolve(), beside.resolve()}))
                if {**folders, **{each: saved(each) for each in read}} != looked:
                    with files_read() as read:
                        version = _written(beside, write, version)
                    looked = {**folders, **read}
                time.sleep(EVERY)
        finally:
            was_written = beside.exists()  # a signal may have come before its version was known here
            beside.unlink(missing_ok=True)
            if was_written:
                with suppress(DocumentError):  # it was shown when it was found
                    write(None)
    return 0


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


def _stamps(file: str, rig: str, but: set[Path]) -> Iterator[tuple[Path, Saved]]:
    """When the files of the sequence's folder, and of the rig's, were saved last: it may come to be made of them."""
    for place in _folders([file, rig]):
        with suppress(OSError):
            for each in sorted(place.iterdir()):
                found = saved(each)
                if each.is_file() and each.resolve() not in but and found is not None and found[1] <= LARGEST:
                    yield each, found


def _folders(names: Sequence[str]) -> Iterator[Path]:
    for name, kind in zip(names, ("sequences", "profiles"), strict=True):
        yield folder(kind) if is_bare(name) and not is_take(name) else Path(name).expanduser().parent
