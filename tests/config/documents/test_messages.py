"""What a beginner's usual mistakes are answered with: one line for each, with its cure."""

from __future__ import annotations

from pathlib import Path

import pytest

from teleop.config.documents.document import DocumentError
from teleop.config.documents.messages import unknown_key
from teleop.config.profile import load_profile
from teleop.sequence.compile import load_sequence

ANGLES = "yaw is called pan here; pitch is tilt"
LIST = "must be a list: start each line with `- `"
START = "keyframes:\n  - {at: 0, pan: 0}\n"


@pytest.mark.parametrize(
    ("text", "problems"),
    [
        (START + "  - {at: 3, pan: 0, pan: 1}\n", ["3:21: key 2: pan: duplicate key"]),
        (START + "  - {at: 3, pan: 0, hodl: 1}\n", ["3:21: key 2: unknown key `hodl`; did you mean `hold`?"]),
        (START + "  - {time: 3, pan: 0}\n", ["3:6: key 2: unknown key `time`; did you mean `at`?"]),
        ("name: x\n" + START, ["1:1: unknown key `name`; did you mean `title`?"]),
        (START + "  - {at: 3, yaw: 5}\n", ["3:13: key 2: unknown key `yaw`: " + ANGLES]),
        (
            START + "  - {at: 3, pitch: 5}\n",
            ["3:13: key 2: unknown key `pitch`: " + ANGLES],
        ),
        (START + "  - {at: 3, pan:5}\n", ["3:13: key 2: a space is missing after `pan:`"]),
        (START + "  - at: 3\n    pan:5\n", ["4:5: a space is missing after `pan:`"]),
        (START + "  - at:3\n    pan: 5\n", ["3:5: a space is missing after `at:`"]),
        (START + "  - pan:5\n", ["3:5: key 2: a space is missing after `pan:`"]),
        (START + "  - {at: 3, pan: 20,5}\n", ["3:18: key 2: pan: 20,5: write 20.5"]),
        (START + "  - {at: 3, pan: -20,5, tilt: 0}\n", ["3:18: key 2: pan: -20,5: write -20.5"]),
        (START + "  - at: 3\n    pan: 20,5\n", ["4:10: key 2: pan: 20,5: write 20.5"]),
        (START + "  - {at: 3,5s, pan: 2}\n", ["3:10: key 2: at: 3,5s: write 3.5s"]),
        (
            "keyframes:\n  at: 0\n  pan: 0\n  at: 4\n  pan: 5\n",
            ["2:3: keyframes " + LIST],
        ),
        ("keyframes:\n", ["1:11: keyframes " + LIST]),
        (
            START + "  - {at: 5, pan: 40}\ncues: [{at: 2, follow: lock}]\n",
            ["4:8: cue 1 is at 2 s, while pan moves; put it at 0 s or 5 s, or add a key with `pass: stop` at 2 s"],
        ),
    ],
)
def test_one_mistake_is_one_line_with_its_cure(tmp_path: Path, text: str, problems: list[str]) -> None:
    (tmp_path / "shoot.yaml").write_text(text)
    with pytest.raises(DocumentError) as caught:
        load_sequence(str(tmp_path / "shoot.yaml"), load_profile("sim").limits, "sim")
    assert caught.value.problems == [f"{tmp_path}/shoot.yaml:{problem}" for problem in problems]


def test_a_suggestion_is_a_key_of_the_level_at_hand() -> None:
    assert unknown_key("hodl", ["at", "pan"], {}) == "unknown key `hodl`"
    assert unknown_key("yaw", ["at", "link"], {}) == "unknown key `yaw`"
    assert unknown_key("speed", ["acceleration", "velocity"], {}) == "unknown key `speed`; did you mean `velocity`?"
    assert unknown_key("old", ["new"], {"old": "new"}) == "`old` is called `new` now"


SINKS = "name: R\nlinks: {g: 'sim:', d: 'sim:'}\naxes: {}\nsinks:\n  - "
OLD_SINKS = [
    ("{type: gimbal, link: g, mode: position, rate: 50, follow: 5}", "follow", "max_following_error"),
    ("{type: focus, link: g, rate: 50, follow: 0.1}", "follow", "max_following_error"),
    ("{type: flight, link: d, mode: tilt, full: {horizontal: 1, vertical: 1, yaw: 1}}", "full", "full_scale"),
]
OLD_INPUTS = [
    ("{frozen: 10}", "frozen", "stuck_timeout"),
    ("{controls: {X: {axis: pan, reads: absolute}}}", "reads", "value_type"),
    ("{controls: {X: {axis: pan, centre: 0}}}", "centre", "center"),
    ("{controls: {Button 1: {press: tell, words: gimbal recenter}}}", "words", "command"),
    ("{controls: {Hat: {up: {press: tell, words: gimbal recenter}}}}", "words", "command"),
]


@pytest.mark.parametrize(
    ("text", "old", "new"),
    [(SINKS + text, old, new) for text, old, new in OLD_SINKS]
    + [(SINKS + OLD_SINKS[0][0] + f"\ninputs:\n  - {text}", old, new) for text, old, new in OLD_INPUTS],
)
def test_an_old_key_of_a_profile_is_refused_with_its_new_name(tmp_path: Path, text: str, old: str, new: str) -> None:
    (tmp_path / "rig.yaml").write_text(text + "\n")
    with pytest.raises(DocumentError) as caught:
        load_profile(str(tmp_path / "rig.yaml"))
    about = [problem for problem in caught.value.problems if f"`{new}`" in problem]
    assert len(about) == 1
    assert about[0].endswith(f": `{old}` is called `{new}` now")
    assert not [problem for problem in caught.value.problems if problem.endswith(f"{new} is missing")]


def test_an_old_key_of_a_timelapse_is_refused_with_its_new_name(tmp_path: Path) -> None:
    (tmp_path / "dusk.yaml").write_text(
        "timelapse: {frames: 3, interval: 5s, exposure: 1, camera_fault: go-on}\nkeyframes: [{at: 0, pan: 1}]\n"
    )
    with pytest.raises(DocumentError) as caught:
        load_sequence(str(tmp_path / "dusk.yaml"), load_profile("sim").limits, "sim")
    assert caught.value.problems == [
        f"{tmp_path}/dusk.yaml:1:51: timelapse: `camera_fault` is called `on_camera_fault` now"
    ]
