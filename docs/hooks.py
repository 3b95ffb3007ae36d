"""Makes the pages that the code or another folder already has: reference, profiles, sequences, changelog."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

ROOT = Path(__file__).parents[1]
INCLUDED = {
    "how-to/profiles.md": "profiles/README.md",
    "how-to/sequences.md": "sequences/README.md",
    "changelog.md": "CHANGELOG.md",
}
"""Pages that are kept elsewhere in the repository, by the path that they have on the site."""


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the generated pages. Raises what the program raises: a page that cannot be made fails the build."""
    pages = {path: _moved(ROOT / source) for path, source in INCLUDED.items()}
    pages |= {
        "reference/commands.md": commands(),
        "reference/keys.md": keys(),
        "reference/files.md": schemas(),
    }
    for path, text in pages.items():
        files.append(File.generated(config, path, content=text))
    return files


def _moved(source: Path) -> str:
    """A page of the repository with its links to files that are not on the site taken out."""
    text = re.sub(r"\[([^\]]+)\]\((?!https?://|#)[^)]*?([\w-]+\.md)?(#[\w-]+)?\)", _link, source.read_text())
    return _fences_without_marks(text)


def _link(found: re.Match[str]) -> str:
    known = {"README.md": "", "protocol-facts.md": "../protocol-facts.md"}
    page = found[2] or ""
    return f"[{found[1]}]({known[page]})" if known.get(page) else found[1]


def on_page_markdown(markdown: str, **_: Any) -> str:
    return _fences_without_marks(markdown)


def _fences_without_marks(text: str) -> str:
    """What tests/docs reads behind a block's language is not for the reader."""
    return re.sub(r"^```(\w+) [^\n]*$", r"```\1", text, flags=re.MULTILINE)


def commands() -> str:
    """Every command's help, as the program prints it."""
    from teleop.cli import COMMANDS

    parts = ["# Commands", "", "What `teleop COMMAND --help` prints.", ""]
    for name in COMMANDS:
        parts += [f"## teleop {name}", "", *_block(help_of(name))]
        for inner in _inner(name):
            parts += [f"### teleop {name} {inner}", "", *_block(help_of(name, inner))]
    return "\n".join(parts)


def help_of(*words: str) -> str:
    """The help of a command, in 100 columns."""
    import io
    from contextlib import redirect_stdout

    from rich.console import Console

    from teleop.cli import app

    out = io.StringIO()
    with redirect_stdout(out):
        console = Console(file=out, width=100, color_system=None, force_terminal=False)
        app.help_print(list(words), console=console)
    return out.getvalue()


def _inner(name: str) -> list[str]:
    from teleop.cli.examples import EXAMPLES

    return [each.partition(" ")[2] for each in EXAMPLES if each.startswith(f"{name} ")]


def _block(text: str) -> list[str]:
    return ["```text", *(line.rstrip() for line in text.strip("\n").splitlines()), "```", ""]


def keys() -> str:
    """The keys of the terminal, from the keymaps."""
    from teleop.inputs.keymaps import HELP
    from teleop.inputs.playback_keymap import KEYS

    rows = [f"| {_cell(key)} | {_cell(what)} |" for key, what in HELP]
    names: dict[str, list[str]] = {}
    for key, press in KEYS.items():
        if not key.startswith("\x1b["):
            command = getattr(press, "command", None)
            names.setdefault(str(command), []).append(_key(key))
    played = [f"| {_cell('  '.join(dict.fromkeys(each)))} | {what} |" for what, each in names.items()]
    head = ["| key | what it does |", "|---|---|"]
    return "\n".join(["# Keys", "", "## teleop live", "", *head, *rows, "", "## teleop play", "", *head, *played, ""])


def _key(key: str) -> str:
    return {" ": "space", "\n": "Enter", "\r": "Enter", "\x1bOC": "right arrow", "\x1bOD": "left arrow"}.get(key, key)


def _cell(text: str) -> str:
    escaped = text.replace("|", "\\|")
    return f"`{escaped}`" if not re.search(r"\s\S.*\s", text) and "`" not in text else escaped


def schemas() -> str:
    """Every key of sequences, profiles and pads, from their JSON Schemas."""
    from teleop.app.json_schema import KINDS, schema

    parts = ["# Keys of files", "", "From the schemas that `teleop schema KIND` prints.", ""]
    for kind in KINDS:
        whole = schema(kind)
        parts += [f"## {kind}", "", *_table(whole)]
        for name, inner in whole.get("$defs", {}).items():
            if inner.get("properties"):
                parts += [f"### {kind}: {name}", "", *([inner["description"], ""] if "description" in inner else [])]
                parts += _table(inner)
    return "\n".join(parts)


def _table(section: Mapping[str, Any]) -> Iterator[str]:
    yield from ("| key | default | what it is |", "|---|---|---|")
    for key, value in section.get("properties", {}).items():
        default = "" if "default" not in value else f"`{json.dumps(value['default'])}`"
        text = _plain(str(value.get("description", ""))).replace("|", "\\|")
        yield f"| `{key}` | {default} | {text} |"
    yield ""


def _plain(text: str) -> str:
    return " ".join(text.split()).replace("[", "\\[").replace("<", "&lt;")
