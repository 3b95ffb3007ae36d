"""What is refused of a timelapse with `blur`, and that what the refusal suggests would do."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from timelapse_bench import LIMITS

from teleop.config.documents.document import DocumentError
from teleop.core.axes import Axis
from teleop.timelapse.compile import Timelapse, load_timelapse

FILE = """\
keyframes:
- {at: 0, pan: FROM}
- {at: 9, pan: 40}
timelapse:
  frames: 10
  interval: INTERVAL
  exposure: EXPOSURE
  blur: BLUR
"""


def load(folder: Path, **values: object) -> Timelapse:
    text, given = FILE, {"interval": "1m", "exposure": "1s", "blur": 0.5, "from": 0, **values}
    for name, value in given.items():
        text = text.replace(name.upper(), str(value))
    (folder / "dusk.yaml").write_text(text)
    found = load_timelapse(str(folder / "dusk.yaml"), LIMITS, "the rig")
    assert found is not None
    return found


def problem(folder: Path, **values: object) -> str:
    with pytest.raises(DocumentError) as caught:
        load(folder, **values)
    [text] = caught.value.problems
    return text.split("dusk.yaml:")[1]


def test_no_blur_is_no_run(tmp_path: Path) -> None:
    assert load(tmp_path, blur=0).runs is None
    assert load(tmp_path, blur=0.5).runs is not None


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"blur": 1.5}, "8:9: timelapse.blur must be at most 1"),
        ({"blur": -1}, "8:9: timelapse.blur must be at least 0"),
        ({"blur": "much"}, "8:9: timelapse.blur must be a number, not 'much'"),
        (
            {"blur": "0.5\n  mode: continuous"},
            "8:9: timelapse.blur cannot be used with mode: continuous: there the camera moves all the time",
        ),
        (
            {"exposure": 0},
            "7:13: timelapse.exposure must be more than 0 s with blur: the camera moves through the exposure",
        ),
    ],
)
def test_a_blur_that_means_nothing_is_refused(tmp_path: Path, values: dict[str, object], said: str) -> None:
    assert problem(tmp_path, **values) == said


def test_a_run_too_fast_for_the_rig_is_refused_with_what_would_do(tmp_path: Path) -> None:
    said = problem(tmp_path, exposure="0.05s", blur=1)
    found = re.fullmatch(
        r"8:9: timelapse\.blur is too much: frame (\d) of 10: pan needs [\d.]+ x its (\w+) limit to move through the "
        r"exposure; an exposure of at least ([\d.]+) s or a blur of at most ([\d.]+) would do",
        said,
    )
    assert found is not None, said
    exposure, blur = float(found[3]), float(found[4])
    load(tmp_path, exposure=f"{exposure}s", blur=1)
    load(tmp_path, exposure="0.05s", blur=blur)
    assert "is too much" in problem(tmp_path, exposure=f"{exposure - 0.02:.2f}s", blur=1)
    assert "is too much" in problem(tmp_path, exposure="0.05s", blur=blur + 0.002)


def test_a_run_beyond_a_soft_limit_is_refused_with_what_would_do(tmp_path: Path) -> None:
    said = problem(tmp_path, **{"from": -180}, blur=1)
    assert re.search(r"frame \d of 10: pan leaves its soft limits by \d+ deg on its run through it; ", said)
    blur = re.search(r"a blur of at most ([\d.]+) would do", said)
    assert blur is not None, said
    found = load(tmp_path, **{"from": -180}, blur=float(blur[1]))
    assert found.runs is not None
    assert found.runs[Axis.PAN].starts.min() >= -180


def test_the_interval_holds_run_up_exposure_run_out_and_the_way_to_the_next_run(tmp_path: Path) -> None:
    said = problem(tmp_path, interval="1s")
    found = re.search(
        r"6:13: timelapse\.interval must be at least ([\d.]+) s, not 1 s: frame \d of 10 takes run-up 1 s \+ exposure "
        r"1 s \+ run-out 1 s \+ move [\d.]+ s \+ settle 0\.3 s",
        said,
    )
    assert found is not None, said
    assert 3.3 < float(found[1]) < 5
    assert "is tight" in load(tmp_path, interval=f"{found[1]}s").warnings[0]
