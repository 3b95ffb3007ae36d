"""A pad at rest, a profile and a session of learning that has both."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from fake_hid import JOYSTICK
from learn_bench import F310, REST, SIM, LearnBench, Pad, Pads, Time, learning


@pytest.fixture
def time() -> Time:
    return [0.0]


@pytest.fixture
def pad(time: Time) -> Pad:
    pad = Pad(time, F310, name="Logitech F310", usage=JOYSTICK)
    pad.report(REST)
    return pad


@pytest.fixture
def rig(tmp_path: Path) -> Path:
    file = tmp_path / "mine.yaml"
    file.write_text(SIM)
    return file


@pytest.fixture
def bench(rig: Path, time: Time, pad: Pad) -> Iterator[LearnBench]:
    with learning(rig, time, Pads([pad])) as bench:
        yield bench
