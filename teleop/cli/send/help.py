"""The help of `teleop send`: usage and options as every command has them, then every command that can be typed."""

from __future__ import annotations

import shutil
import textwrap
from collections.abc import Iterator, Sequence

from teleop.cli.examples import examples
from teleop.config.documents.document import DocumentError
from teleop.dji.command_parser import Vocabulary, help_of
from teleop.dji.drone.command_table import DRONE
from teleop.dji.gimbal.command_table import RIG

VOCABULARIES = (RIG, DRONE)
_WIDTH = 100  # columns at most: longer lines are hard to read
_NO_BREAK = "\N{NO-BREAK SPACE}"


def print_help(words: Sequence[str]) -> None:
    """All of it, or the part that the words begin. Raises DocumentError where they begin nothing."""
    from teleop.cli import app

    width = min(shutil.get_terminal_size().columns, _WIDTH)
    beginning = " ".join(word for word in words if "=" not in word)
    lines = [line for vocabulary in VOCABULARIES for line in _vocabulary(vocabulary, beginning, width)]
    if not lines:
        raise DocumentError([f"no command begins with {' '.join(words)!r}; teleop send --help lists everything"])
    app.help_print(["send"])
    print(*lines, sep="\n")
    if not words:
        print("", examples("send"), sep="\n")


def _vocabulary(vocabulary: Vocabulary, beginning: str, width: int) -> Iterator[str]:
    """Lines of at most `width` columns on the commands that begin so, with or without their device."""
    for device in vocabulary.devices:
        plain = [
            _shortest(vocabulary, name).replace(" ", _NO_BREAK)
            for name in vocabulary.plain
            if _begins(name, device, beginning)
        ]
        if plain:
            yield from ("", f"{device}: plain words", *_wrapped("  ", "  ", ", ".join(plain), width))
        for name, command in vocabulary.commands.items():
            if command not in vocabulary.refused and _begins(name, device, beginning):
                yield from ("", f"{name}, sent once without a reply" if not command.has_reply else name)
                yield from _wrapped("  ", "  ", " ".join((command.__doc__ or "").split()), width)
                for field, requirement, default in help_of(command):
                    text = requirement if default is None else f"{requirement} [default: {default}]"
                    yield from _wrapped(f"    {field:20}", " " * 24, text, width)


def _begins(name: str, device: str, beginning: str) -> bool:
    shapes = (name, name.removeprefix(f"{device} ")) if name.startswith(f"{device} ") else ()
    return any(f"{shape} ".startswith(f"{beginning} ".lstrip()) for shape in shapes)


def _shortest(vocabulary: Vocabulary, name: str) -> str:
    """The words without their device, where they mean the same; only a drone's always need it."""
    short = name.partition(" ")[2]
    return short if vocabulary is RIG and RIG.find(short.split()) == RIG.plain[name] else name


def _wrapped(first: str, later: str, text: str, width: int) -> list[str]:
    lines = textwrap.wrap(text, width, initial_indent=first, subsequent_indent=later)
    return [line.replace(_NO_BREAK, " ") for line in lines]
