"""Makes the pages that the code or another folder already has: reference, examples, changelog."""

from __future__ import annotations

import json
import posixpath
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

ROOT = Path(__file__).parents[1]
LINK = re.compile(r"\[([^\]]+)\]\((?!https?://|#)([^)]+)\)")


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the generated pages. Raises what the program raises: a page that cannot be made fails the build."""
    pages = {
        "changelog.md": _without_links((ROOT / "CHANGELOG.md").read_text(encoding="utf-8")),
        "how-to/examples.md": examples(),
        "reference/commands.md": commands(),
        "reference/keys.md": keys(),
        "reference/files.md": schemas(),
    }
    for path, text in pages.items():
        files.append(File.generated(config, path, content=text))
    return files


def _without_links(text: str) -> str:
    """Links to files of the repository become plain text: the site does not have these files."""
    return LINK.sub(r"\1", text)


def examples() -> str:
    """The list of examples/, then every program."""
    folder = ROOT / "examples"
    programs = sorted(folder.glob("*.py"))
    text = (folder / "README.md").read_text(encoding="utf-8").replace("(../docs/", "(../")
    for program in programs:
        text = text.replace(f"({program.name})", f"(#{program.name.replace('.', '')})")
    text = LINK.sub(lambda link: link[0] if link[2].endswith(".md") else link[1], text)
    parts = [f"## {each.name}\n\n```python\n{each.read_text(encoding='utf-8')}```\n" for each in programs]
    return "\n".join([text, *parts])


def on_page_markdown(markdown: str, page: Page, **_: Any) -> str:
    """Take out the marks behind a block's language, which are for tests/docs; lead links to examples/ to their page."""
    examples_page = posixpath.relpath("how-to/examples.md", posixpath.dirname(page.file.src_uri))
    markdown = re.sub(r"\((?:\.\./)+examples/README\.md\)", f"({examples_page})", markdown)
    if page.file.src_uri == "reference/api.md":
        markdown = with_public_names(markdown)
    return re.sub(r"^```(\w+) [^\n]*$", r"```\1", markdown, flags=re.MULTILINE)


def with_public_names(markdown: str) -> str:
    """The API's page with an entry for each public function, class and error; Rig and Move are the first classes."""
    import teleop

    kinds: dict[str, list[str]] = {"functions": [], "classes": [], "errors": []}
    for name in sorted(teleop.__all__, key=lambda name: (name != "Rig", name != "Move", name != "TeleopError", name)):
        value = getattr(teleop, name)
        kind = "functions" if not isinstance(value, type) else "errors" if issubclass(value, Exception) else "classes"
        kinds[kind].append(name)
    for kind, names in kinds.items():
        entries = [f"::: teleop.{name}\n    options: {{heading_level: 3}}\n" for name in names]
        markdown = markdown.replace(f"<!-- {kind} -->", "\n".join(entries))
    return markdown


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
    """The keys of the terminal, from the keymaps. Raises KeyError for a key's command that has no words below."""
    from teleop.core.operator_input import Command, Press
    from teleop.inputs.keymaps import HELP
    from teleop.inputs.playback_keymap import BY_HAND_KEYS, KEYS, TRIM_KEYS

    words = {
        Command.STOP: "STOP all axes (motors stay on)",
        Command.CLEAR: "clear STOP",
        Command.PAUSE: "pause on the path, then continue",
        Command.SLOWER: "slower",
        Command.FASTER: "faster",
        Command.NEXT: "next key, while paused",
        Command.PREVIOUS: "previous key, while paused",
        Command.GO: "start a move that waits; continue after a STOP",
        Command.QUIT: "quit",
        Command.RANGE: "next speed range of the trim",
        Command.RECENTER: "take the trim back to 0",
        Command.KEEP: "write the sequence with the trim in its keys",
    }

    def rows(keymap: Mapping[str, Any], words: Mapping[Command, str] = words) -> Iterator[tuple[str, str]]:
        of: dict[Command, list[str]] = {}
        for key, press in keymap.items():
            if isinstance(press, Press) and not key.startswith("\x1b"):
                of.setdefault(press.command, []).append(KEY_NAMES.get(key, key))
        return ((" ".join(dict.fromkeys(names)), words[command]) for command, names in of.items())

    frames = {
        Command.NEXT: "next frame",
        Command.PREVIOUS: "frame back",
        Command.GO: "shoot the frame; continue after a STOP",
        Command.PAUSE: "halt, then continue",
    }
    trim = {key: press for key, press in TRIM_KEYS.items() if key not in KEYS}
    parts = ["# Keys", "", "## teleop live", "", *_key_table(HELP)]
    parts += ["## teleop play", "", *_key_table(rows(KEYS)), "The arrows right and left are `>` and `<`.", ""]
    parts += ["## teleop play --by-hand", "", *_key_table(rows(BY_HAND_KEYS, {**words, **frames}))]
    parts += ["The arrows right and left are `.` and `,`.", ""]
    parts += ["## teleop play --trim", "", "These, and the keys of `teleop live` that move an axis.", ""]
    return "\n".join([*parts, *_key_table(rows(trim))])


KEY_NAMES = {" ": "space", "\n": "Enter", "\r": "Enter"}


def _key_table(rows: Iterable[tuple[str, str]]) -> Iterator[str]:
    yield from ("| key | what it does |", "|---|---|")
    yield from (f"| `{key}` | {what} |" for key, what in rows)
    yield ""


def schemas() -> str:
    """Every key of sequences, profiles and pads, from their JSON Schemas."""
    from teleop.app.json_schema import KINDS, schema

    parts = ["# Keys of files", "", "From the schemas that `teleop schema KIND` prints.", ""]
    for kind in KINDS:
        whole = schema(kind)
        parts += [f"## {kind}", "", *_table(whole)]
        for name, inner in whole.get("$defs", {}).items():
            if inner.get("properties"):
                parts += [f"### {_place(name, whole)} of a {kind}", "", *filter(None, [inner.get("description")]), ""]
                parts += _table(inner)
    return "\n".join(parts)


def _place(name: str, whole: Mapping[str, Any]) -> str:
    """Where a part of a schema is used: the keys that have it as their value."""
    sections = (whole, *whole["$defs"].values())
    keys = [
        key
        for each in sections
        for key, value in each.get("properties", {}).items()
        if f'/{name}"' in json.dumps(value)
    ]
    kind = whole["$defs"][name]["properties"].get("type", {}).get("const")
    return ", ".join(f"`{key}`" for key in dict.fromkeys(keys)) + (f" with `type: {kind}`" if kind else "")


def _table(section: Mapping[str, Any]) -> Iterator[str]:
    yield from ("| key | default | what it is |", "|---|---|---|")
    for key, value in section.get("properties", {}).items():
        default = "" if "default" not in value else f"`{json.dumps(value['default'])}`"
        text = _plain(str(value.get("description", ""))).replace("|", "\\|")
        yield f"| `{key}` | {default} | {text} |"
    yield ""


def _plain(text: str) -> str:
    return " ".join(text.split()).replace("[", "\\[").replace("<", "&lt;")
