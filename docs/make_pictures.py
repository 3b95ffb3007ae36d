"""Make the pictures of the program in docs/pictures, or in another folder.

    python docs/make_pictures.py [FOLDER]

Each screen is that of a real terminal of 80 x 24 on which the program runs, drawn as SVG without an external font. The
pages are photographed by Chromium, where it is installed. Needs `pip install '.[test]'`.
"""

from __future__ import annotations

import fcntl
import os
import re
import select
import shutil
import struct
import subprocess
import sys
import tempfile
import termios
import time
from collections.abc import Sequence
from itertools import groupby
from pathlib import Path
from xml.sax.saxutils import escape

import pyte
from pyte.screens import Char

Keys = Sequence[tuple[str, str]]
"""What to type, and the regular expression to wait for before."""

COLUMNS, LINES = 80, 24
WIDTH, HEIGHT, MARGIN = 8.4, 18, 12  # pixels of a character, and around the screen
GROUND, TEXT = "#16181d", "#e9ecef"
COLORS = {"black": "#5c6370", "red": "#ff6b68", "green": "#8cc265", "brown": "#e5c07b", "blue": "#61afef"}
COLORS |= {"magenta": "#c678dd", "cyan": "#56b6c2", "white": "#dcdfe4"}
FONT = "ui-monospace, 'DejaVu Sans Mono', Menlo, Consolas, monospace"
NO_BREAK = "&#160;"  # a space that SVG keeps
LONGEST = 60  # s for a text to appear
TELEOP = [sys.executable, "-c", "import sys; from teleop.cli import main; main(sys.argv[1:])"]
SCREENS: dict[str, tuple[list[str], Keys, str]] = {
    "check": (["check", "reveal"], (), r"OK: "),
    "play": (["play", "reveal"], (), r"[5-9]\.\d / 15\.0 s"),
    "commission": (
        ["commission", "-o", "my-rig.yaml"],
        (
            *(("Leave 10 cm", "\n"), ("unlocked and on", "y"), ("Balanced and", "\n")),
            *((f"step {number} ", "s") for number in range(5, 9)),
        ),
        "pan goes 2 deg",
    ),
    "commission-drone": (["commission", "--rig", "sim-drone"], (), "Take all propellers off"),
    "live": (["live"], (("arrows jog", "L"), (r"pan .* \+10\.00 ", "K"), (r"tilt .* \+10\.00 ", "s1")), "presets +1"),
}
"""By picture: the command, what is typed, and the text that it has when the picture is taken."""


def main(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for name, (command, keys, until) in SCREENS.items():
        screen = None
        while screen is None:
            with tempfile.TemporaryDirectory() as place:
                screen = run(command, keys, until, Path(place))
                for page in Path(place).glob("commission-*/report.html"):
                    shot(page, folder / "commission-report.png")
        (folder / f"{name}.svg").write_text(drawn(screen, " ".join(["teleop", *command])), encoding="utf-8")
    photograph(folder)


def run(command: Sequence[str], keys: Keys, until: str, place: Path) -> list[list[Char]] | None:
    """The screen of a command, started in the folder `place`, once it shows `until`; then the command is ended.

    None when the run ended because a busy computer stalled it. Raises TimeoutError when the text does not come.
    """
    master, slave = os.openpty()
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", LINES, COLUMNS, 0, 0))
    environment = {**os.environ, "TERM": "xterm-256color", "XDG_STATE_HOME": str(place)}
    screen = pyte.Screen(COLUMNS, LINES)
    stream = pyte.ByteStream(screen)
    process = subprocess.Popen(
        [*TELEOP, *command],
        stdin=slave,
        stdout=slave,
        stderr=slave,
        cwd=place,
        env=environment,
        start_new_session=True,
        preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0),  # keys are read only from one's own terminal
    )
    os.close(slave)
    try:
        for text, typed in (*keys, (until, "")):
            wait_for(text, master, screen, stream)
            os.write(master, typed.encode())
        return [[screen.buffer[line][column] for column in range(COLUMNS)] for line in range(LINES)]
    except TimeoutError as error:
        if "the computer stalled" not in str(error):
            raise
        return None
    finally:
        process.terminate()
        while read(master):
            pass
        process.wait(LONGEST)
        os.close(master)


def wait_for(text: str, master: int, screen: pyte.Screen, stream: pyte.ByteStream) -> None:
    """Read until the screen has `text`. Raises TimeoutError with what it has instead."""
    end = time.monotonic() + LONGEST
    while not re.search(text, "\n".join(screen.display)):
        ready, _, _ = select.select([master], [], [], max(0, end - time.monotonic()))
        data = read(master) if ready else b""
        if not data:
            raise TimeoutError(f"no {text!r} in\n" + "\n".join(screen.display))
        stream.feed(data)


def read(master: int) -> bytes:
    """What the program wrote, b"" once it has ended."""
    try:
        return os.read(master, 65536)
    except OSError:  # Linux's answer when nothing has the other end open
        return b""


def drawn(screen: Sequence[Sequence[Char]], title: str) -> str:
    """The screen as SVG, without the empty lines at its end."""
    used = max((number for number, row in enumerate(screen, 1) if any(char.data != " " for char in row)), default=1)
    width, height = COLUMNS * WIDTH + 2 * MARGIN, used * HEIGHT + 2 * MARGIN
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" width="{width:g}" role="img">',
        f"<title>{escape(title)}</title>",
        f'<rect width="100%" height="100%" rx="6" fill="{GROUND}"/>',
        f'<g font-family="{FONT}" font-size="14" fill="{TEXT}">',
    ]
    for number, row in enumerate(screen[:used]):
        parts += spans(row, MARGIN + number * HEIGHT)
    return "\n".join([*parts, "</g></svg>", ""])


def spans(row: Sequence[Char], top: float) -> list[str]:
    """The characters of a line, those of one style together; each span has its width, whatever the font."""
    parts: list[str] = []
    column = 0
    for style, chars in groupby(row, lambda char: (char.fg, char.bg, char.bold, char.reverse)):
        text = "".join(char.data for char in chars)
        fore, back, bold, reverse = style
        ink, ground = color(fore, TEXT), color(back, GROUND)
        ink, ground = (ground, ink) if reverse else (ink, ground)
        left, width = MARGIN + column * WIDTH, len(text) * WIDTH
        if ground != GROUND:
            parts.append(f'<rect x="{left:g}" y="{top:g}" width="{width:g}" height="{HEIGHT}" fill="{ground}"/>')
        if text.strip():
            marks = f' fill="{ink}"' * (ink != TEXT) + ' font-weight="bold"' * bold
            place = f'x="{left:g}" y="{top + 13:g}" textLength="{width:g}" lengthAdjust="spacingAndGlyphs"'
            parts.append(f"<text {place}{marks}>{escape(text).replace(' ', NO_BREAK)}</text>")
        column += len(text)
    return parts


def color(name: str, default: str) -> str:
    """A color of pyte: a name, six hexadecimal digits, or "default"."""
    if re.fullmatch(r"[0-9a-f]{6}", name):
        return f"#{name}"
    return COLORS.get(name.removeprefix("bright"), default)


def photograph(folder: Path) -> None:
    """The preview of a move and the report of a take, as PNG."""
    with tempfile.TemporaryDirectory() as place:
        for command in (
            "preview reveal -o preview.html",
            "play reveal --fast --take reveal.mcap",
            "take report reveal.mcap -o report.html",
        ):
            subprocess.run([*TELEOP, *command.split()], cwd=place, check=True, capture_output=True)
        for name in ("preview", "report"):
            shot(Path(place, f"{name}.html"), folder / f"{name}.png")


def shot(page: Path, picture: Path) -> None:
    """A photograph of a page."""
    browser = shutil.which("chromium") or shutil.which("google-chrome")
    if browser is None:
        sys.stderr.write(f"Chromium is not installed: no {picture.name}\n")
        return
    options = ["--headless", "--no-sandbox", "--hide-scrollbars", "--window-size=840,450"]
    shown = f"--screenshot={picture.resolve()}"
    subprocess.run([browser, *options, shown, page.as_uri()], check=True, capture_output=True, timeout=LONGEST)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent / "pictures")
