"""`teleop commission --console` on a terminal of 80 x 24: how the page of a browser is reached, and the page below."""

from __future__ import annotations

from pathlib import Path

from terminal_screen import screen


def test_a_key_shows_the_address_and_while_that_covers_the_page_no_other_goes_on(tmp_path: Path) -> None:
    options = ("-o", "mine.yaml", "--console", "127.0.0.1:0")
    with screen("commission", *options, folder=tmp_path, cwd=tmp_path) as terminal:
        terminal.wait_for("Leave 10 cm")
        terminal.wait_for("Console: o shows its address")
        terminal.type("o")
        terminal.wait_for("Console: http://127.0.0.1:")
        terminal.look(key_line="o back")
        terminal.type("\n")
        terminal.type("o")
        terminal.wait_for("Leave 10 cm")
        terminal.look(key_line="Enter goes")  # that Enter was for the page below, and did not go
        terminal.type("\n")
        terminal.wait_for("balanced, unlocked and on?")
        terminal.type("q")
        assert terminal.end() == 1  # nothing was found
