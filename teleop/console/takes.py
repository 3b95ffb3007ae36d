"""Takes for the page: a list with what came of each, the report, the file itself, and keyframes made of it."""

from __future__ import annotations

import asyncio
import math
from collections import OrderedDict
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from urllib.parse import quote

from starlette.requests import Request
from starlette.responses import FileResponse, Response

from teleop.config.files_read import saved
from teleop.config.named_files import NamedFiles
from teleop.console.answers import answer
from teleop.console.commands import require_operator
from teleop.console.json_body import Refusal, read_object
from teleop.console.moves import MoveRoutes
from teleop.console.worker import Worker
from teleop.recording import ENDING

PATIENCE = 2.0  # s that a list waits for the errors of takes that were not read before
MOST_KEPT = 2000  # takes whose errors are kept
MOST_TOLERANCE = 45.0  # deg
REPORT_POLICY = (
    "sandbox allow-scripts; default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline';"
    " img-src data:; frame-ancestors 'none'"
)
"""A report is one file with its scripts in it. The sandbox makes it a stranger to this console."""
Stamp = tuple[str, int, int]


class TakeRoutes:
    """Handlers of `/api/takes` and `/takes`. Reports are made by `worker`."""

    def __init__(self, takes: Path, moves: MoveRoutes, worker: Worker) -> None:
        self._files, self._moves, self._worker = NamedFiles(takes, (ENDING,)), moves, worker
        self._entries: OrderedDict[Stamp, Mapping[str, Any]] = OrderedDict()
        self._reports: OrderedDict[Stamp, Mapping[str, Any]] = OrderedDict()

    async def list(self, _: Request) -> Response:
        """Every take of the folder, the newest first. `peaks` are null for those that are still to be read."""
        loop = asyncio.get_running_loop()
        end = loop.time() + PATIENCE
        entries = []
        for file in self._files.files():
            entry = dict(await self._entry(file))
            known = self._reports.get(_stamp(file))
            if known is None and "title" in entry and loop.time() < end:
                known = await self._report(file)
            entry["peaks"] = None if known is None else known.get("peaks")
            entries.append(entry)
        return answer({"takes": sorted(entries, key=lambda entry: entry.get("started", ""), reverse=True)})

    async def read(self, request: Request) -> Response:
        """One take with the errors of each axis."""
        file = self._find(request)
        found = await self._report(file)
        if "error" in found:
            raise Refusal(422, found["error"])
        return answer({**await self._entry(file), **found})

    async def keys(self, request: Request) -> Response:
        """Keyframes fitted to a take; `save` makes a new move of them."""
        require_operator(request)
        file = self._find(request)
        data = await read_object(request)
        tolerance, save = data.get("tolerance", 0.2), data.get("save")
        is_number = isinstance(tolerance, int | float) and not isinstance(tolerance, bool)
        if not is_number or not math.isfinite(tolerance) or not 0 < tolerance <= MOST_TOLERANCE:
            raise Refusal(400, f"tolerance: must be a number above 0 and at most {MOST_TOLERANCE:g}")
        if not isinstance(save, str | None):
            raise Refusal(400, "save: must be the name of a new move")
        if save is not None:
            self._moves.check_new(save)
        found = await self._worker.do("take_keys", str(file), tolerance)
        if "error" in found:
            raise Refusal(422, found["error"])
        if save is not None:
            await self._moves.save_new(save, found["text"])
        return answer({"ok": True, **found})

    async def page(self, request: Request) -> Response:
        """The report as a page."""
        found = await self._worker.do("take_page", str(self._find(request)))
        if "error" in found:
            raise Refusal(422, found["error"])
        return Response(found["html"], 200, {"content-security-policy": REPORT_POLICY}, "text/html; charset=utf-8")

    async def download(self, request: Request) -> Response:
        """The file itself."""
        file = self._find(request)
        return FileResponse(file, media_type="application/octet-stream", filename=file.name)

    def _find(self, request: Request) -> Path:
        if (file := self._files.find(request.path_params["name"])) is None:
            raise Refusal(404, "no take of that name")
        return file

    async def _entry(self, file: Path) -> Mapping[str, Any]:
        url = f"/takes/{quote(file.stem)}"
        links = {"report": f"{url}/report", "download": f"{url}/download"}
        return {**await self._kept(self._entries, "take", file), **links}

    async def _report(self, file: Path) -> Mapping[str, Any]:
        return await self._kept(self._reports, "take_report", file)

    async def _kept(self, kept: OrderedDict[Stamp, Mapping[str, Any]], job: str, file: Path) -> Mapping[str, Any]:
        """What a job says of a file, which is done again only when the file has changed."""
        stamp = _stamp(file)
        if stamp not in kept:
            kept[stamp] = await self._worker.do(job, str(file))
            while len(kept) > MOST_KEPT:
                kept.popitem(last=False)
        return kept[stamp]


def _stamp(file: Path) -> Stamp:
    if (when := saved(file)) is None:
        raise Refusal(404, "no take of that name")
    return str(file), *when
