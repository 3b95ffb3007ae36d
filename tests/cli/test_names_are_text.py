"""Titles and names of files are text: printed as they are, whatever they look like, and none acts on a terminal."""

from __future__ import annotations

import io
import os
import re
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
import yaml
from hypothesis import example, given, settings
from hypothesis import strategies as st
from made_takes import at_rest, write_take
from rich.text import Text

from teleop.cli import printable, run
from teleop.cli.screens.picture import Rows
from teleop.core.axes import Axis
from teleop.core.plain import plain

STYLE = re.compile(r"\x1b\[[0-9;]*m")
NASTY = "[take 2] [/home] [bold] :smile: \x1b[2J\x07\r\n\t\u202e\u2028👩‍👩‍👧é漢\x9b31m#'\"\\{}%s"
MARKUP = ["[/home]", "[red]", ":boom:", "\x1b]0;x\a", "{0}", "%d"]
PIECES = st.one_of(st.sampled_from(NASTY), st.sampled_from(MARKUP), st.characters())
TITLES = st.lists(PIECES, max_size=40).map("".join)
RAW = st.one_of(TITLES.map(lambda text: text.encode("utf-8", "replace")), st.binary(max_size=12))
NAMES = RAW.map(lambda name: name.replace(b"/", b"").replace(b"\0", b""))


class Terminal(io.TextIOWrapper):
    def isatty(self) -> bool:
        return True


@contextmanager
def streams(kind: type[io.TextIOWrapper], encoding: str) -> Iterator[list[str]]:
    """What is printed meanwhile, on stdout and on stderr."""
    raw, printed, before = [io.BytesIO(), io.BytesIO()], ["", ""], (sys.stdout, sys.stderr)
    sys.stdout, sys.stderr = written = [kind(each, encoding=encoding, write_through=True) for each in raw]
    printable()
    try:
        yield printed
    finally:
        sys.stdout, sys.stderr = before
        for each in written:
            each.flush()
        printed[:] = [each.getvalue().decode(encoding) for each in raw]


def teleop(*arguments: str, kind: type[io.TextIOWrapper], encoding: str = "utf-8") -> tuple[int, str]:
    """The exit code, and what is on stdout. Nothing that is printed acts on a terminal but the table's own styles."""
    with streams(kind, encoding) as printed:
        code = run(arguments)
    out, err = (STYLE.sub("", each) if kind is Terminal else each for each in printed)
    for line in (out + err).split("\n"):
        assert plain(line) == line
    return code, out


@settings(max_examples=int(os.environ.get("TELEOP_NAMES", "12")))
@given(TITLES, NAMES, st.sampled_from([io.TextIOWrapper, Terminal]))
@example("Night sky [take 2] [/home]", b"a[b] :smile:", io.TextIOWrapper)
@example(NASTY, NASTY.replace("/", "").encode(), Terminal)
@example("x" * 200, b"\xff\x1b[31m\n", Terminal)
def test_every_command_prints_them_as_they_are(title: str, name: bytes, kind: type[io.TextIOWrapper]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        stem = os.fsdecode(name[:60]).lstrip("-") + "x"
        file = os.path.join(folder, f"{stem}.yaml")
        keys = [{"at": 0, "pan": 0}, {"at": 1, "pan": 3}]
        Path(file).write_text(yaml.safe_dump({"title": title, "keyframes": keys}))
        code, out = teleop("check", file, kind=kind)
        if code == 0:
            shown = plain(" ".join(title.split()) or stem)
            assert out.startswith(f"{shown}: 1.00 s on Simulated rig\n") or (kind is Terminal and shown[:20] in out)
        else:
            assert code == 2
        teleop("check", file, kind=kind, encoding="ascii")
        teleop("check", file, "--json", kind=kind)
        assert teleop("preview", file, "-o", f"{file}.html", kind=kind)[0] == code
        assert teleop("preview", file, "--csv", f"{file}.csv", kind=io.TextIOWrapper)[0] == code
        assert teleop("play", file, "--fast", kind=io.TextIOWrapper)[0] == code
        assert teleop("check", f"{file}.gone.yaml", kind=kind)[0] == 2
        called = stem.encode("utf-8", "replace").decode()  # as another program may have written it
        take = os.path.join(folder, f"{stem}.mcap")
        write_take(Path(folder, f"{called}.mcap"), {Axis.PAN: at_rest(1.0)}, 0.3).rename(take)
        for arguments in (["list", folder], ["info", take], ["report", take], ["recover", take], ["report", file]):
            teleop("take", *arguments, kind=kind)


def test_a_row_of_a_screen_has_no_control_characters() -> None:
    (row,) = Rows(Text.assemble((" teleop play ", "bold"), NASTY)).fitted(200, 1)
    assert row.plain == plain(row.plain)
    assert "[take 2] [/home] [bold] :smile: \\x1b[2J" in row.plain


def test_what_is_no_control_character_stays(capsys: pytest.CaptureFixture[str]) -> None:
    assert plain("[/home] :smile: é漢 👩‍👩‍👧 \u00a0") == "[/home] :smile: é漢 👩‍👩‍👧 \u00a0"
    assert plain("a\x1b[2J\n\udcff\u202e\x9b") == r"a\x1b[2J\n\xff\u202e\x9b"
