"""Sequence files that would choke whoever reads them: refused soon, in a line or a few, at a place if there is one."""

from __future__ import annotations

import os
import re
import time
from pathlib import Path

import pytest
from command import teleop
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from sequences import LIMITS, load, problems_of
from teleop.config.documents.document import DocumentError
from teleop.sequence.compile import load_sequence

SOON = 4.0  # s of this thread's own work, whatever else the machine does; each takes less than one
LAUGHS = "\n".join(["a0: &a0 x"] + [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 12)])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        pytest.param("[" * 3_999_999, "is nested too deeply", id="4 MB of brackets"),
        pytest.param("[" * 100_000 + "]" * 100_000, "is nested too deeply", id="100 000 deep"),
        pytest.param("".join(" " * i + "a:\n" for i in range(1000)), "is nested too deeply", id="deep mappings"),
        pytest.param("- " * 500_000, "is nested too deeply", id="deep lists"),
        pytest.param("? " * 500_000, "is nested too deeply", id="deep keys"),
        pytest.param(LAUGHS, "too many values; aliases count each time", id="billion laughs"),
        pytest.param("a: &a [*a]", "is nested too deeply", id="within itself"),
        pytest.param("-\n" * 1_900_000, "holds too many values", id="two million values"),
        pytest.param("{" + "a: 1, " * 600_000 + "}", "holds too many values", id="600 000 keys"),
        pytest.param("a: '" + "x" * 3_999_000, "not YAML", id="a scalar without an end"),
        pytest.param("#\n" * 1_900_000, "the file is empty", id="comments"),
        pytest.param("title: a\0b\n", "1:9: not YAML: a control character, U+0000", id="NUL"),
        pytest.param("title: " + "x" * 4_000_000, "is larger than 4 MB", id="too large"),
    ],
)
@pytest.mark.timeout(30)
def test_refused_soon(tmp_path: Path, text: str, said: str) -> None:
    began = time.thread_time()
    problems = problems_of(tmp_path, text)
    assert time.thread_time() - began < SOON
    assert any(said in problem for problem in problems), problems
    assert all(len(problem) < 300 and "\n" not in problem for problem in problems)


@pytest.mark.parametrize("digits", ["9" * 290, "9" * 310, "9" * 3_000_000, "0x" + "f" * 1000, "1e999", ".inf", "-.nan"])
@pytest.mark.parametrize("key", ["pan", "at", "hold", "fps"])
def test_numbers_that_are_none_are_refused_in_words(tmp_path: Path, digits: str, key: str) -> None:
    values = {"at": "0", "pan": "1", "hold": "0", "fps": "24"} | {key: digits}
    text = "fps: {fps}\nkeyframes:\n  - {{at: {at}, pan: {pan}, hold: {hold}}}\n".format(**values)
    with pytest.raises(DocumentError) as caught:
        load(tmp_path, text)
    assert all(len(problem) < 400 for problem in caught.value.problems)


def test_a_hundred_thousand_keyframes_are_too_many_and_it_says_so_soon(tmp_path: Path) -> None:
    began = time.thread_time()
    text = "keyframes:\n" + "".join(f"  - {{at: {i}, pan: {i % 7}}}\n" for i in range(100_000))
    [problem] = problems_of(tmp_path, text)
    assert time.thread_time() - began < SOON
    assert problem == "shoot.yaml:32001:10: holds too many values"
    text = "keyframes:\n" + "".join(f"  - {{at: {i}, pan: {i % 7}}}\n" for i in range(12_000))
    assert problems_of(tmp_path, text) == ["shoot.yaml:1:1: needs 12000 keys of pan; the maximum is 10000"]


def test_of_many_errors_the_first_are_told_and_the_others_counted(tmp_path: Path) -> None:
    text = "keyframes:\n" + "".join(f"  - {{at: {i}, pna: 1}}\n" for i in range(5000))
    (tmp_path / "wrong.yaml").write_text(text)
    began = time.thread_time()
    with pytest.raises(DocumentError) as caught:
        load_sequence(str(tmp_path / "wrong.yaml"), LIMITS, "the rig")
    assert time.thread_time() - began < SOON
    assert len(caught.value.problems) + caught.value.more == 10_000  # each has no axis, and a key that is not known
    done = teleop("check", "wrong.yaml", cwd=tmp_path)
    assert done.returncode == 2
    lines = done.stderr.splitlines()
    assert lines[0].startswith("wrong.yaml:2:5: key 1 has no axis")
    assert (len(lines), lines[-1]) == (51, "teleop: and 9950 more")


@pytest.mark.timeout(20)
def test_what_is_no_file_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.yaml")
    (tmp_path / "folder.yaml").mkdir()
    for name in ("pipe.yaml", "folder.yaml"):
        with pytest.raises(DocumentError, match="is no file"):
            load_sequence(str(tmp_path / name), LIMITS, "the rig")
    with pytest.raises(DocumentError, match=r"/dev/zero: is no file"):
        load_sequence("/dev/zero", LIMITS, "the rig")


_WORDS = """
0 1 -1 3s 96f 00:01:00;02 null true [] {} 30% 1e308 .inf .nan reveal lock operator record stop bounce soft
"""
_VALUES = st.sampled_from([*_WORDS.split(), "[54, 38]", "{arrive: 1s}", "gimbal stiffness", "9" * 300])


def _section(*keys: str) -> st.SearchStrategy[str]:
    pairs = st.lists(st.tuples(st.sampled_from(keys), _VALUES), max_size=5, unique_by=lambda pair: pair[0])
    return pairs.map(lambda given: "{" + ", ".join(f"{key}: {value}" for key, value in given) + "}")


_SECTIONS = {
    "keyframes": ("at", "pan", "tilt", "focus", "hold", "pass", "ease"),
    "cues": ("at", "camera", "follow", "recenter", "send", "wait"),
    "include": ("move", "at", "speed"),
    "panorama": ("fov", "overlap", "pan", "tilt", "every", "settle", "at"),
    "repeat": ("times", "mode"),
    "timelapse": ("frames", "interval", "exposure", "settle"),
}
_LISTS = ("keyframes", "cues", "include")


@st.composite
def documents(draw: st.DrawFn) -> str:
    lines = [f"{key}: {draw(_VALUES)}" for key in ("fps", "tension", "ease", "preroll") if draw(st.booleans())]
    for key, keys in _SECTIONS.items():
        sections = draw(st.lists(_section(*keys), max_size=3 if key in _LISTS else 1))
        if sections:
            lines.append(f"{key}: [{', '.join(sections)}]" if key in _LISTS else f"{key}: {sections[0]}")
    return "\n".join(lines) + "\n"


@given(documents())
@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_document_is_a_performance_or_has_errors_with_places(tmp_path: Path, text: str) -> None:
    try:
        load(tmp_path, text)
    except DocumentError as error:
        for problem in error.problems:
            assert re.search(r"\.yaml:\d+:\d+: ", problem) or "the file is empty" in problem, problem
