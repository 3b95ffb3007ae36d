"""Moves for the page: a list, one to edit, saving it with its comments kept, and plans of what is not saved yet."""

from __future__ import annotations

import asyncio
import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from starlette.requests import Request
from starlette.responses import Response

from teleop.config.documents.yaml_edit import block
from teleop.config.files import OutputError, write_text
from teleop.config.files_read import saved
from teleop.config.named_files import NamedFiles
from teleop.config.resources import described, folder
from teleop.console.answers import answer
from teleop.console.commands import require_operator
from teleop.console.json_body import Refusal, read_object
from teleop.console.worker import Worker

MOST_TEXT = 1_000_000  # bytes of a move: one of 2000 keys has 0.2 MB
MOST_BODY = 2_100_000  # of a request with it: JSON needs more for each line end and quote
MOST_DESCRIBED = 3000  # files, of which titles are kept
MOST_DEPTH = 32  # as in a file
ENDINGS = (".yaml", ".yml")
UNNAMED = "move"
WARMING = "keyframes: [{at: 0, pan: 0}, {at: 4, pan: 1}, {at: 8, pan: 0}]\n"
NO_NAME = "not a name for a move: use letters, digits, spaces, `.`, `-` and `_`"


class MoveRoutes:
    """Handlers of `/api/moves` and `/api/plan`. `rig` is what is planned for; `worker` plans."""

    def __init__(self, moves: Path, rig: str, worker: Worker) -> None:
        self._files, self._folder, self._rig, self._worker = NamedFiles(moves, ENDINGS), moves, rig, worker
        self._saving = asyncio.Lock()
        self._described: dict[tuple[str, int, int], Mapping[str, Any]] = {}

    async def warm(self) -> None:
        """Have everything loaded that a plan needs."""
        await self._plan(WARMING, UNNAMED)

    async def list(self, _: Request) -> Response:
        """Every move of the folder and every shipped one that no file of the folder hides."""
        entries = {}
        for file in self._files.files():
            if (found := await self._description(file)) is not None:
                entries.setdefault(file.stem, {"name": file.stem, "shipped": False, **found})
        for name in described("sequences"):
            found = await self._description(folder("sequences") / f"{name}.yaml")
            entries.setdefault(name, {"name": name, "shipped": True, **(found or {})})
        return answer({"moves": [entries[name] for name in sorted(entries)]})

    async def read(self, request: Request) -> Response:
        """The text and the values of a move."""
        name = request.path_params["name"]
        file, shipped = await self._find(name)
        text = await asyncio.to_thread(_text, file)
        found = await self._worker.do("parse", text, name)
        return answer({"name": name, "shipped": shipped, "version": version(text), "text": text, **found})

    async def save(self, request: Request) -> Response:
        """Write a move that can be planned; a shipped one becomes a file of the folder."""
        require_operator(request)
        name = request.path_params["name"]
        data = await read_object(request, MOST_BODY, MOST_DEPTH)
        own = self._files.find(name)
        if own is None and self._files.place(name) is None:
            raise Refusal(400, NO_NAME)
        if own is not None and await self._description(own) is None:
            raise Refusal(409, f"{name} is the name of a file that is no move: choose another one")
        async with self._saving:
            text = await self._new_text(name, data)
            found = await self._plan(text, name)
            if not found.get("ok"):
                return answer(found, 422)
            self._write(name, text)
        return answer({"ok": True, "name": name, "version": version(text), "text": text})

    async def plan(self, request: Request) -> Response:
        """The plan of a move that is saved or not."""
        return answer(await self.planned(await read_object(request, MOST_BODY, MOST_DEPTH)))

    async def planned(self, data: Mapping[str, Any]) -> Mapping[str, Any]:
        """The plan of `move`, `text` or `content`. Raises Refusal (400, 404)."""
        given = [key for key in ("move", "text", "content") if key in data]
        if len(given) != 1:
            raise Refusal(400, "give one of move, text and content")
        value = data[given[0]]
        name = data.get("name", UNNAMED)
        if not isinstance(name, str) or not name.isprintable() or "/" in name or not name.strip(". "):
            raise Refusal(400, "name: must be the name of a move")
        if given == ["move"]:
            if not isinstance(value, str):
                raise Refusal(400, "move: must be the name of a move")
            return await self._plan(_text((await self._find(value))[0]), value)
        return await self._plan(_given_text(data) if given == ["text"] else _fresh(_values(value)), name)

    async def save_new(self, name: str, text: str) -> None:
        """A new move of this name. Raises Refusal (400, 409)."""
        async with self._saving:
            self.check_new(name)
            self._write(name, text)

    def check_new(self, name: str) -> None:
        """Raises Refusal for what is not the name of a new move."""
        if self._files.find(name) is not None:
            raise Refusal(409, f"there is a move {name} already")
        if self._files.place(name) is None:
            raise Refusal(400, NO_NAME)

    async def _find(self, name: str) -> tuple[Path, bool]:
        """The file of a move, and whether it is shipped. Raises Refusal (404), also for a file that is no move."""
        own = self._files.find(name)
        if own is not None and await self._description(own) is not None:
            return own, False
        if name in described("sequences"):
            return folder("sequences") / f"{name}.yaml", True
        raise Refusal(404, "no move of that name")

    async def _new_text(self, name: str, data: Mapping[str, Any]) -> str:
        """What the file will be. Raises Refusal: 409 where it has changed since it was read."""
        try:
            old = _text((await self._find(name))[0])
        except Refusal:
            old = None
        known = data.get("version")
        if known is not None and known != ("" if old is None else version(old)):
            raise Refusal(409, "the move has been saved by someone else since: load it again")
        if "text" in data:
            return _given_text(data)
        content = _values(data.get("content"))
        if old is None:
            return _fresh(content)
        found = await self._worker.do("edit", old, content, name)
        if "error" in found:
            raise Refusal(422, found["error"], problems=[], segments=[])
        return found["text"]

    def _write(self, name: str, text: str) -> None:
        place = self._files.find(name) or self._files.place(name)
        if place is None:
            raise Refusal(400, NO_NAME)
        try:
            write_text(place, text)
        except OutputError as error:
            raise Refusal(422, f"the move cannot be written: {error.reason}") from None

    async def _plan(self, text: str, name: str) -> Mapping[str, Any]:
        return await self._worker.do("plan", text, name, str(self._folder.resolve()), self._rig)

    async def _description(self, file: Path) -> Mapping[str, Any] | None:
        """Title and kind of a file; None for one that is no move. Files that have not changed are not read again."""
        if (when := saved(file)) is None:
            return None
        key = str(file), *when
        if key not in self._described:
            if len(self._described) >= MOST_DESCRIBED:
                self._described.clear()
            self._described[key] = await self._worker.do("describe", str(file))
        found = self._described[key]
        return None if found.get("kind") == "" else found


def version(text: str) -> str:
    """Changes with the text."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _text(file: Path) -> str:
    """The text of a file. Raises Refusal (422) for one that is no text."""
    try:
        with file.open("rb") as stream:
            raw = stream.read(MOST_TEXT + 1)
        if len(raw) > MOST_TEXT:
            raise Refusal(422, f"the move is too large for the page: at most {MOST_TEXT} bytes")
        return raw.decode()
    except (OSError, UnicodeDecodeError):
        raise Refusal(422, "the move cannot be read") from None


def _given_text(data: Mapping[str, Any]) -> str:
    text = data["text"]
    if not isinstance(text, str):
        raise Refusal(400, "text: must be the YAML text of a move")
    if len(text.encode()) > MOST_TEXT:
        raise Refusal(413, f"too large: at most {MOST_TEXT} bytes")
    return text


def _values(content: Any) -> Mapping[str, Any]:
    if not isinstance(content, dict) or not content:
        raise Refusal(400, 'content: must be the values of a move, as in {"keyframes": [...]}')
    return content


def _fresh(content: Mapping[str, Any]) -> str:
    """Values as a new YAML text."""
    return "\n".join(block(content, 0)) + "\n"
