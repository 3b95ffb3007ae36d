"""List every text of the package that a user may read, so that a reviewer can read them all at once.

    python tests/support/list_messages.py            writes tests/messages/messages.txt
    python tests/support/list_messages.py --check    exits with 1 where that file is out of date

The texts come from the source, not from a run: prose in string literals (errors, warnings, screens, `help=`), the
docstrings of commands, and the docstrings of attributes that become options or keys of a JSON Schema. A text with a
variable in it has a {placeholder} there. Line numbers are left out: only a changed text changes the file.
"""

from __future__ import annotations

import ast
import inspect
import re
import sys
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).parents[2]
EXPECTED = ROOT / "tests" / "messages" / "messages.txt"
REGENERATE = "python tests/support/list_messages.py"

_PROSE = re.compile(r"[^\W\d_]{2,}[,;:.]? +[^\W\d_]{2,}|[^\W\d_]{3,} \{|\} [^\W\d_]{3,}")
_LONGEST = 40  # letters of a placeholder: a longer expression is no name
_NO_TEXT_CALLS = {"compile", "match", "search", "fullmatch", "sub", "split", "findall", "getLogger", "TypeVar", "debug"}
_SCHEMA_ROOMS = {"config", "sequence", "timelapse", "manual", "inputs", "cli"}  # their attributes' docstrings are read
_TERMS = re.compile(r"^ *-{3,} *\n", re.MULTILINE)


def messages() -> str:
    """The text of the expected file: each source file's path, then its texts in order, sorted by path."""
    parts = []
    for file in sorted((ROOT / "teleop").rglob("*.py")):
        if found := texts(file, room_of(file)):
            lines = "\n".join(_indented(text) for text in found)
            parts.append(f"{file.relative_to(ROOT).as_posix()}\n{lines}\n")
    return "\n".join(parts)


def texts(file: Path, room: str) -> list[str]:
    """What a user may read of one source file of a room (the folder below teleop/): in the file's order, each once."""
    found = _Texts(room).of(ast.parse(file.read_text(encoding="utf-8")))
    return list(dict.fromkeys(found))


def room_of(file: Path) -> str:
    """The folder below teleop/ that a source file is in."""
    return file.relative_to(ROOT / "teleop").parts[0]


class _Texts(ast.NodeVisitor):
    """Collects the texts of a module. Where a text is found whole, its parts are not looked at."""

    def __init__(self, room: str) -> None:
        self._room = room
        self._found: list[str] = []

    def of(self, tree: ast.Module) -> Iterable[str]:
        self.visit(tree)
        return self._found

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        if self._room == "cli" and _is_command(node) and (text := ast.get_docstring(node)):
            self._found.append(_TERMS.sub("", text))
        self.generic_visit(node)

    def visit_Expr(self, node: ast.Expr) -> None:
        """A string that stands by itself is a docstring: of a command, of an attribute, or for programmers."""
        if not isinstance(node.value, ast.Constant):
            self.generic_visit(node)

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        if self._room in _SCHEMA_ROOMS and not any("NamedTuple" in ast.unparse(base) for base in node.bases):
            for attribute, after in zip(node.body, node.body[1:], strict=False):
                if isinstance(attribute, ast.AnnAssign) and (text := _standing(after)):
                    self._found.append(f"{ast.unparse(attribute.target)}: {text}")
        self.generic_visit(node)

    def visit_Raise(self, node: ast.Raise) -> None:
        """Whatever an error is given is read, also a single word."""
        if isinstance(node.exc, ast.Call):
            for argument in node.exc.args:
                text = _text(argument)
                if text is not None and re.search(r"[^\W\d_]{2}", text) and not _PROSE.search(text):
                    self._found.append(text)
        self.generic_visit(node)

    def visit_Call(self, node: ast.Call) -> None:
        name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        if name not in _NO_TEXT_CALLS:
            self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> None:
        self._add(node)

    def visit_JoinedStr(self, node: ast.JoinedStr) -> None:
        self._add(node)
        for part in node.values:
            if isinstance(part, ast.FormattedValue):
                self.visit(part.value)

    def _add(self, node: ast.expr) -> None:
        text = _text(node)
        if text is not None and _PROSE.search(text):
            self._found.append(text.strip())


def _text(node: ast.expr) -> str | None:
    """The text of a literal, with placeholders; None of anything else."""
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else None
    if isinstance(node, ast.JoinedStr):
        return "".join(_part(part) for part in node.values)
    return None


def _part(part: ast.expr) -> str:
    if isinstance(part, ast.Constant):
        return str(part.value)
    value = ast.unparse(part.value) if isinstance(part, ast.FormattedValue) else "..."
    return "{" + (value if len(value) <= _LONGEST and "\n" not in value else "...") + "}"


def _standing(node: ast.stmt) -> str | None:
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
        return inspect.cleandoc(node.value.value)
    return None


def _is_command(node: ast.FunctionDef) -> bool:
    """A function with options (`Parameter(...)`, or a docstring with a list of parameters), or that is registered."""
    if node.name.startswith("_") and not node.decorator_list:
        return False
    marks = [ast.unparse(each) for each in node.decorator_list]
    annotations = " ".join(
        ast.unparse(each.annotation)
        for each in [*node.args.args, *node.args.posonlyargs, *node.args.kwonlyargs]
        if each.annotation
    )
    return (
        any(re.search(r"\b(command|default)\b", mark) for mark in marks)
        or "Parameter(" in annotations
        or "Json" in annotations
        or "\n---" in (ast.get_docstring(node) or "")
    )


def _indented(text: str) -> str:
    first, *rest = text.splitlines() or [""]
    return "\n".join([f"  {first}", *(f"      {line}".rstrip() for line in rest)])


def main(arguments: list[str]) -> int:
    """Write the expected file, or check it."""
    text = messages()
    if "--check" not in arguments:
        EXPECTED.write_text(text, encoding="utf-8")
        return 0
    if EXPECTED.read_text(encoding="utf-8") == text:
        return 0
    sys.stderr.write(f"{EXPECTED.relative_to(ROOT)} is out of date: {REGENERATE}\n")
    return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
