"""The page's own files, read once into a table: what is not in it does not exist, whatever a request names."""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from starlette.requests import Request
from starlette.responses import Response

FOLDER = Path(__file__).parent / "static"
LOGIN_PAGE = Path(__file__).parent / "login.html"  # beside the folder: it is all that is served without a login
UPLOT = Path(__file__).parents[1] / "plots" / "vendor" / "uplot"
TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".ico": "image/x-icon",
    ".webmanifest": "application/manifest+json",
    ".json": "application/json",
}
"""By ending; files with any other ending are not served."""


@dataclass(frozen=True)
class StaticFile:
    """The content of a file, its type, and a tag that changes with it."""

    content: bytes
    type: str
    tag: str

    @classmethod
    def of(cls, file: Path) -> StaticFile:
        content = file.read_bytes()
        return cls(content, TYPES[file.suffix], f'"{hashlib.sha256(content).hexdigest()[:24]}"')

    def answer(self, request: Request, headers: Mapping[str, str] | None = None) -> Response:
        """The file, or 304 for a client that has it."""
        kept = {"etag": self.tag, "cache-control": "no-cache", **(headers or {})}
        if request.headers.get("if-none-match") == self.tag:
            return Response(status_code=304, headers=kept)
        return Response(self.content, headers=kept, media_type=self.type)


@cache
def static_files() -> Mapping[str, StaticFile]:
    """By URL path every file that the page is made of."""
    found = {
        f"/{file.relative_to(FOLDER).as_posix()}": file
        for file in sorted(FOLDER.rglob("*"))
        if file.is_file() and file.suffix in TYPES
    }
    found |= {f"/vendor/uplot/{file.name}": file for file in sorted(UPLOT.iterdir()) if file.suffix in TYPES}
    return {path: StaticFile.of(file) for path, file in found.items()}


@cache
def login_page() -> tuple[StaticFile, str]:
    """The login page, whole in one file, and its policy, which allows just the script and the style in it."""
    file = StaticFile.of(LOGIN_PAGE)
    text = file.content.decode()
    hashes = {tag: _hash(re.findall(rf"<{tag}>(.*?)</{tag}>", text, re.DOTALL)[0]) for tag in ("script", "style")}
    return file, (
        f"default-src 'none'; script-src {hashes['script']}; style-src {hashes['style']}; connect-src 'self';"
        " img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
