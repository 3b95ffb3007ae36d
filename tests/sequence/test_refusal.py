"""What a user reads of a refused file: a line for each cause, no more than twenty, and suggestions that do."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from refused_moves import LIMITS, noise

from teleop.config.documents.document import UnplayableError
from teleop.core.axes import Axis
from teleop.sequence.compile import load_sequence
from teleop.timelapse.compile import load_timelapse

PANORAMA = """panorama:
  fov: [54, 38]
  pan: [-90, 90]
  tilt: [-10, 30]
  every: {every}
  settle: 0.3s
"""


def refused(path: Path, text: str, name: str = "move.yaml") -> UnplayableError:
    file = path / name
    file.write_text(text, encoding="utf-8")
    with pytest.raises(UnplayableError) as caught:
        load_sequence(str(file), LIMITS, "rig")
    return caught.value


def keyframes(rows: list[dict[str, float]], head: str = "") -> str:
    lines = [", ".join(f"{key}: {value!r}" for key, value in row.items()) for row in rows]
    return f"{head}keyframes:\n" + "".join(f"  - {{{line}}}\n" for line in lines)


def test_a_panorama_that_is_too_fast_is_one_line_whose_time_does(tmp_path: Path) -> None:
    (line,) = refused(tmp_path, PANORAMA.format(every="1.1s")).problems
    found = re.search(r":5:10: panorama\.every must be at least ([\d.]+) s, not 1.1 s: pan needs", line)
    assert found
    least = float(found[1])
    (tmp_path / "move.yaml").write_text(PANORAMA.format(every=f"{least}s"), encoding="utf-8")
    assert load_sequence(str(tmp_path / "move.yaml"), LIMITS, "rig").duration > 0
    (line,) = refused(tmp_path, PANORAMA.format(every=f"{0.95 * least:.3f}s")).problems
    assert f"panorama.every must be at least {least:g} s" in line


def test_an_included_panorama_has_the_time_of_its_own_file(tmp_path: Path) -> None:
    (alone,) = refused(tmp_path, PANORAMA.format(every="1.1s"), "wide.yaml").problems
    included = refused(tmp_path, "include:\n  - {move: wide.yaml, at: 0, speed: 100%}\n").problems[0]
    own = re.compile(r"wide.yaml:5:10: (panorama.every must be at least [\d.]+ s)")
    assert own.search(alone)[1] == own.search(included)[1]  # type: ignore[index]


def test_a_file_that_is_included_twice_has_each_mistake_once(tmp_path: Path) -> None:
    (tmp_path / "pan.yaml").write_text(keyframes([{"at": 0, "pan": 0}, {"at": 0.2, "pan": 50}]), encoding="utf-8")
    text = "include:\n  - {move: pan.yaml, at: 0}\n  - {move: pan.yaml, at: 20}\n"
    problems = refused(tmp_path, text).problems
    assert [line for line in problems if "from include 1, key 1 to include 1, key 2" in line]
    assert not [line for line in problems if "from include 2, key 1" in line]


def test_twenty_lines_are_in_full_and_the_others_counted(tmp_path: Path) -> None:
    rows = [{"at": key.at, "pan": key.position} for key in noise(40).keys[Axis.PAN]]
    error = refused(tmp_path, keyframes(rows))
    assert len(error.problems) == 20
    assert error.more > 10
    places = [int(re.findall(r":(\d+):", line)[0]) for line in error.problems]
    assert places == sorted(places)
    assert all("`fit: stretch`" in line for line in error.problems)
    (tmp_path / "move.yaml").write_text(keyframes(rows, "fit: stretch\n"), encoding="utf-8")
    assert load_sequence(str(tmp_path / "move.yaml"), LIMITS, "rig").duration > 1.2 * rows[-1]["at"]


def test_a_timelapse_is_refused_in_the_same_way(tmp_path: Path) -> None:
    head = "timelapse: {frames: 60, interval: 2s, exposure: 0.1s}\nease: 40f\n"
    (tmp_path / "move.yaml").write_text(keyframes([{"at": 0, "pan": 0}, {"at": 59, "pan": 20}], head), encoding="utf-8")
    with pytest.raises(UnplayableError, match=r"move.yaml:5:5: pan needs 160.000 s for its ramps"):
        load_timelapse(str(tmp_path / "move.yaml"), LIMITS, "rig")
