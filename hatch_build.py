"""Makes the wheel small: its modules have no comments and no docstrings of their own. Every line keeps its number."""

from __future__ import annotations

import ast
import base64
import hashlib
import io
import tokenize
import zipfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class SmallWheel(BuildHookInterface):
    """Not for an editable install, which has the sources themselves."""

    PLUGIN_NAME = "custom"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:  # noqa: ARG002
        if version == "standard":
            shrink(Path(artifact_path))


def shrink(wheel: Path) -> None:
    """Write the wheel again with bare modules, and what RECORD has of them."""
    with zipfile.ZipFile(wheel) as archive:
        entries = [(entry, archive.read(entry)) for entry in archive.infolist()]
    made = wheel.with_suffix(".small")
    records: dict[str, str] = {}
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for entry, content in entries:
            if entry.filename.endswith(".py"):
                content = bare(content.decode(), is_package=entry.filename.endswith("/__init__.py")).encode()
                records[entry.filename] = record(entry.filename, content)
            elif entry.filename.endswith(".dist-info/RECORD"):
                lines = content.decode().splitlines()
                content = "".join(f"{records.get(line.split(',')[0], line)}\n" for line in lines).encode()
            archive.writestr(entry, content)
    made.replace(wheel)


def record(name: str, content: bytes) -> str:
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}"


def bare(source: str, is_package: bool = False) -> str:
    """Without comments; a module that is no package also without its docstring."""
    lines = source.splitlines(keepends=True)
    for token in tokenize.generate_tokens(io.StringIO(source).readline) if "#" in source else ():
        if token.type == tokenize.COMMENT:
            row, column = token.start
            lines[row - 1] = lines[row - 1][:column].rstrip() + "\n"
    first, *others = ast.parse(source).body or [None]
    if not is_package and others and isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant):
        lines[first.lineno - 1 : first.end_lineno] = ["\n"] * ((first.end_lineno or 0) - first.lineno + 1)
    return "".join(lines)
