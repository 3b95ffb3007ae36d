"""Without a terminal a screen is lines on stderr; silent, nothing but what has to be said."""

from __future__ import annotations

import pytest

from teleop.cli.screens.picture import Rows
from teleop.cli.screens.screen import Screen
from teleop.core.events import Tick


class Shown(Screen):
    def observe(self, tick: Tick) -> None: ...

    def _draw(self, width: int, height: int) -> Rows:
        raise AssertionError("there is no terminal")


@pytest.mark.parametrize(("silent", "printed"), [(False, "A title\nteleop: a word\n"), (True, "teleop: a word\n")])
def test_the_title_is_for_people_and_what_is_said_for_all(
    silent: bool, printed: str, capfd: pytest.CaptureFixture[str]
):
    screen = Shown("A title", silent)
    with screen:
        screen.notify("a word")
        assert screen._in_lines is not silent
    assert capfd.readouterr().err == printed


def test_what_is_said_is_there_when_the_run_fails(capfd: pytest.CaptureFixture[str]):
    screen = Shown("A title", True)

    def run() -> None:
        with screen:
            screen.notify("the last word")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        run()
    assert capfd.readouterr().err == "teleop: the last word\n"
