"""A page without scripts, to be printed or handed on: what is the same of all such pages."""

from __future__ import annotations

import html
import re
from collections.abc import Iterable
from pathlib import Path

_WEB = Path(__file__).parent / "web"


def printed_page(name: str, kind: str, title: str, content: Iterable[str]) -> str:
    """The HTML text: the browser's `name` for it, a line above the `title`, and below it `content`, which is HTML."""
    parts = {
        "name": html.escape(name),
        "kind": html.escape(kind),
        "title": html.escape(title),
        "style": (_WEB / "printed.css").read_text(encoding="utf-8").strip(),
        "content": "\n".join(content),
    }
    text = (_WEB / "printed.html").read_text(encoding="utf-8")
    return re.sub(r"{{(\w+)}}", lambda match: parts[match[1]], text)
