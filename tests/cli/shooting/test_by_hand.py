"""Single frames on a terminal, as an animator has them."""

from __future__ import annotations

from pathlib import Path

import pytest
from terminal import terminal

from teleop.cli.running import EXIT_CODES
from teleop.core.run_state import Result

FILE = """
title: Walk
fps: 24
keyframes:
  - {at: 0, pan: 0}
  - {at: 2, pan: 2}
timelapse: {frames: 3, interval: 0.1s, exposure: 0.05s, settle: 0s}
"""


def test_frames_are_shot_with_enter_and_gone_to_with_the_arrows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "walk.yaml").write_text(FILE)
    with terminal("play", "walk.yaml", "--by-hand", folder=tmp_path) as term:
        term.wait_for("frame 0 of 3, not shot: ready")
        term.type("\r")
        term.wait_for("frame 1 of 3, not shot: ready")
        term.type("\x1b[C")
        term.wait_for("frame 2 of 3, not shot: ready")
        term.type(",,")
        term.wait_for("frame 0 of 3, shot: ready")
        term.type("q")
        code, out = term.end()
        assert term.restored
    assert "1 of 3 frames shot" in out
    assert "Continue with --by-hand --resume: frame 1 is next (walk.journal)" in " ".join(out.split())
    assert code == EXIT_CODES[Result.INTERRUPTED]
