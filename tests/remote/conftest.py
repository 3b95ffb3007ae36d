from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from at_once import AtOnce
from remote_bench import ANNA, RemoteBench, remote_bench

from teleop.app.planning import plan_content, plan_file
from teleop.remote import made_jobs, works
from teleop.remote.planning_process import played_of, shot_of
from teleop.sequence.source import SequenceSource
from teleop.timelapse.journal import open_journal

MOVE = """
title: There and back
keyframes:
  - {at: 0, pan: 0, tilt: 0}
  - {at: 2s, pan: 20, tilt: 5}
  - {at: 4s, pan: 0, tilt: 0}
"""
SHOOT = """
title: Slow turn
fps: 24
keyframes:
  - {at: 0, pan: 0}
  - {at: 5, pan: 10}
timelapse:
  frames: 6
  interval: 1s
  mode: shoot-move-shoot
  exposure: 0.2s
  settle: 0.1s
"""


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[RemoteBench]:
    """Nobody has control yet."""
    with remote_bench(tmp_path) as made:
        yield made


@pytest.fixture
def held(bench: RemoteBench) -> RemoteBench:
    """Anna has control."""
    assert "ok" in bench.ask("take_control")
    return bench


@pytest.fixture
def planned(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Plans in this process: the other one takes a second to start. The disk is waited for: time is virtual."""

    class Here:
        def __init__(self, profile: Any) -> None:
            self._profile = profile

        def plan(self, what: Any) -> Any:
            plan = plan_file(what, self._profile) if isinstance(what, str) else plan_content(what, self._profile)
            return played_of(plan)

        def timelapse(self, file: str) -> Any:
            return shot_of(plan_file(file, self._profile))

        def close(self) -> None: ...

    monkeypatch.setattr(works, "PlanningProcess", Here)
    # A thread that looks for a change of speed takes real time, and the clock here does not wait for it.
    monkeypatch.setattr(made_jobs, "SequenceSource", partial(SequenceSource, executor=AtOnce()))
    monkeypatch.setattr(made_jobs, "open_journal", partial(open_journal, patient=True))
    (tmp_path / "there.yaml").write_text(MOVE)
    (tmp_path / "turn.yaml").write_text(SHOOT)


@pytest.fixture
def free(tmp_path: Path, planned: None) -> Iterator[RemoteBench]:
    """With moves; nobody has control."""
    with remote_bench(tmp_path) as bench:
        yield bench


@pytest.fixture
def stage(free: RemoteBench) -> RemoteBench:
    """With moves; Anna has control, and her page lives."""
    free.ask("take_control")
    free.seen = {ANNA: 0.0}
    return free
