"""`teleop preview --watch`: written again when a file is saved, its mistakes on the page, and clean at the end."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from command import TELEOP
from waiting import DEADLINE, wait_until

from teleop.cli import run, watched_preview

MOVE = "title: {title}\nkeyframes:\n  - {{at: 0, pan: 0}}\n  - {{at: 4s, pan: 20}}\n"


@pytest.fixture
def steps(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Callable[[], object]]]:
    """What happens while the watch sleeps, in turn; then Ctrl-C."""
    monkeypatch.chdir(tmp_path)
    left: list[Callable[[], object]] = []

    def sleep(_seconds: float) -> None:
        if not left:
            raise KeyboardInterrupt
        left.pop(0)()

    monkeypatch.setattr(watched_preview.time, "sleep", sleep)
    yield left
    assert left == []


def save(text: str, at: int) -> None:
    Path("move.yaml").write_text(text)
    os.utime("move.yaml", ns=(at, at))  # a clock of the disk may be coarse


def test_a_saved_file_is_a_new_version_and_a_mistake_is_shown_beside_the_old_one(
    steps: list[Callable[[], object]], capsys: pytest.CaptureFixture[str]
) -> None:
    seen: list[tuple[str, str]] = []

    def look() -> None:
        seen.append((Path("move.html").read_text(), Path("move.html.js").read_text()))

    save(MOVE.format(title="One"), 1)
    steps += [look, lambda: save(MOVE.format(title="Two"), 2), look, lambda: save("keyframes: 3\n", 3), look]
    assert run(["preview", "move.yaml", "-o", "move.html", "--watch"]) == 0
    pages, scripts = zip(*seen, strict=True)
    assert ["<title>One</title>" in page for page in pages] == [True, False, False]
    assert "<title>Two</title>" in pages[1]
    assert pages[2] == pages[1]
    assert len({script.split('"')[1] for script in scripts}) == 2
    assert "move.yaml:1:12: keyframes must be a list" in scripts[2]
    assert "move.yaml:1:12: keyframes must be a list" in capsys.readouterr().err
    assert not Path("move.html.js").exists()


def test_the_last_page_is_not_watched(steps: list[Callable[[], object]]) -> None:
    save(MOVE.format(title="One"), 1)
    assert run(["preview", "move.yaml", "-o", "move.html", "--watch"]) == 0
    assert '"watch":' not in Path("move.html").read_text()
    assert sorted(file.name for file in Path().iterdir()) == ["move.html", "move.yaml"]


def test_what_is_included_from_another_folder_is_watched_too(steps: list[Callable[[], object]]) -> None:
    """Also where it is not there yet."""
    other = Path("other/part.yaml").absolute()
    seen: list[list[str]] = []

    def look() -> None:
        page, script = Path("move.html"), Path("move.html.js")
        seen.append([each.read_text() if each.exists() else "" for each in (page, script)])

    def save_other(pan: int) -> None:
        other.parent.mkdir(exist_ok=True)
        other.write_text(MOVE.format(title="Part").replace("20", str(pan)))
        os.utime(other, ns=(pan, pan))

    save(f"include:\n  - {{move: {other}, at: 0}}\n", 1)
    steps += [look, lambda: save_other(21), look, look, lambda: save_other(22), look, lambda: None, look]
    assert run(["preview", "move.yaml", "-o", "move.html", "--watch"]) == 0
    pages, scripts = zip(*seen, strict=True)
    assert pages[0] == ""
    assert pages[1] == pages[2] != pages[3] == pages[4]
    assert scripts[1] == scripts[2] != scripts[3]


def test_a_signal_that_ends_the_watch_leaves_a_clean_page(tmp_path: Path) -> None:
    (tmp_path / "move.yaml").write_text(MOVE.format(title="One"))
    page, beside = tmp_path / "move.html", tmp_path / "move.html.js"
    command = [TELEOP, "preview", "move.yaml", "-o", "move.html", "--watch"]
    process = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.DEVNULL)
    wait_until(beside.exists, "the page")
    process.terminate()
    assert process.wait(DEADLINE) == -signal.SIGTERM
    assert not beside.exists()
    assert '"watch":' not in page.read_text()


def test_only_a_page_can_be_watched(steps: list[Callable[[], object]], capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["preview", "nudge", "--csv", "move.csv", "--watch"]) == 2
    assert "--watch: needs a page to reload: give -o FILE.html" in capsys.readouterr().err
