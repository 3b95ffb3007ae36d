"""What was learned, put into the inputs of a profile: all of it loads, and what was not learned stays."""

from __future__ import annotations

import copy
import re
from typing import Any

import pytest
from fake_hid import GAMEPAD
from hypothesis import given, settings
from hypothesis import strategies as st

from teleop.app.learn.answers import Answer, Answers, refusal
from teleop.app.learn.merge import merged
from teleop.app.learn.questions import Question, questions
from teleop.config.documents.document import DocumentError
from teleop.config.documents.yaml_edit import block, edited
from teleop.config.documents.yaml_loader import parse_document
from teleop.config.profile import checked_profile
from teleop.config.resources import folder
from teleop.core.axes import Axis
from teleop.inputs.hid.backend import DeviceInfo
from teleop.inputs.hid.learn import Found, Kind

SIM = (folder("profiles") / "sim.yaml").read_text()
DRONE = (folder("profiles") / "m100.yaml").read_text()
INFO = DeviceInfo(b"/dev/hidraw0", 0x046D, 0xC216, "", "A pad # 1", *GAMEPAD, 0)
HATS = ["Hat switch", "joystick 2: Hat switch"]


def profile_of(text: str, *answers: Answer) -> str:
    """The profile with the answers in it; raises DocumentError where it does not load."""
    data = parse_document(text, "rig.yaml").data
    inputs = merged(data.get("inputs"), Answers(list(answers)), [INFO], [HATS])
    done = edited(text, {**data, "inputs": inputs}, "rig.yaml")
    checked_profile(done, "rig.yaml")
    return done


def axes_of(text: str) -> list[Axis]:
    return list(checked_profile(text, "rig.yaml").axes)


@pytest.mark.parametrize("rig", [SIM, DRONE], ids=["gimbal", "drone"])
@pytest.mark.parametrize("towards", [1, -1])
@pytest.mark.parametrize("kind", Kind)
def test_every_answer_that_is_taken_is_one_that_a_profile_may_hold(rig: str, kind: Kind, towards: int) -> None:
    for question in questions(axes_of(rig), dial=True, drone=rig is DRONE):
        found = Found("joystick 2: Control #1", kind, towards)
        if not refusal(question, found):
            profile_of(rig, Answer(question, 0, found), *_back(question, kind, towards))


def _back(question: Question, kind: Kind, towards: int) -> list[Answer]:
    if not question.moves or kind not in (Kind.TRIGGER, Kind.BUTTON):
        return []
    other = Found("Hat switch up", Kind.BUTTON, 1)
    return [Answer(question, 0, other if not refusal(question, other, HATS) else Found("Rz", kind, towards), back=True)]


@pytest.mark.parametrize(
    ("question", "kind", "towards", "why"),
    [
        (Question("", axis=Axis.STICK_YAW), Kind.LEVER, 1, "does not return to its center"),
        (Question("", axis=Axis.STICK_YAW), Kind.WHEEL, 1, "is turned and cannot be held"),
        (Question("", enable=True), Kind.STICK, 1, "is no button"),
        (Question("", enable=True), Kind.TRIGGER, -1, "is no button"),
        (Question("", axis=Axis.PAN), Kind.LEVER, 1, ""),
    ],
)
def test_what_cannot_do_what_is_asked_for_is_refused(question: Question, kind: Kind, towards: int, why: str) -> None:
    assert refusal(question, Found("X", kind, towards)) == (f"X {why}" if why else "")


def test_an_enable_button_is_freed_of_what_it_did() -> None:
    rig = f"{SIM}inputs:\n  - controls:\n      Button 5: {{press: stop}}\n      X: {{axis: pan}}\n"
    done = profile_of(rig, Answer(Question("", enable=True), 0, Found("Button 5", Kind.BUTTON, 1)))
    assert done.endswith("  - controls:\n      X: {axis: pan}\n    enable: Button 5\n")


def test_one_direction_of_a_hat_leaves_the_others() -> None:
    hat = "      Hat switch:   # presets\n        up: {press: recall, number: 1}\n        down: {press: clear}  # c\n"
    rig = f"{SIM}inputs:\n  - controls:\n{hat}"
    stop = next(each for each in questions([]) if each.text.endswith("STOP"))
    done = profile_of(rig, Answer(stop, 0, Found("Hat switch up", Kind.BUTTON, 1)))
    assert "Hat switch:   # presets\n        up: {press: stop}\n" in done
    assert "        down: {press: clear}  # c\n" in done


ASKED = questions([Axis.PAN, Axis.TILT, Axis.ROLL, Axis.FOCUS], dial=True)
NAMES = ["X", "Y", "Slider 2", "Button 1", "Button 2", "joystick 2: X", "Hat switch up", "joystick 2: Hat switch left"]


@st.composite
def entries(draw: st.DrawFn) -> list[dict[str, Any]]:
    """The inputs of a profile, with controls that do something of each kind."""
    names = draw(st.lists(st.sampled_from(["X", "Y", "Z", "Button 1", "Button 3"]), unique=True, min_size=1))
    actions = [{"axis": "pan", "expo": 0.5}, {"axis": "tilt", "invert": True}, {"press": "stop"}, {"press": "quit"}]
    controls: dict[str, Any] = {name: dict(draw(st.sampled_from(actions))) for name in names}
    if draw(st.booleans()):
        controls["Hat switch"] = {"up": {"press": "recall", "number": 1, "hold": "store"}, "left": {"press": "clear"}}
    device = draw(st.sampled_from([{"vendor": 0x046D, "product": 0xC216}, {"name": "Another"}, "any"]))
    return [
        {"device": device, "controls": controls},
        {"device": {"name": "A wheel"}, "controls": {"Dial": {"dial": True}}},
    ]


@st.composite
def given_answers(draw: st.DrawFn) -> list[Answer]:
    names = draw(st.lists(st.sampled_from(NAMES), unique=True, min_size=1, max_size=5))
    asked = draw(st.permutations(ASKED))
    pairs = [(question, Found(name, Kind.BUTTON, 1)) for question, name in zip(asked, names, strict=False)]
    return [Answer(question, 0, found) for question, found in pairs if not refusal(question, found, HATS)]


@settings(max_examples=25, deadline=None)
@given(inputs=entries(), answers=given_answers())
def test_whatever_is_learned_comments_of_what_stays_are_kept(
    inputs: list[dict[str, Any]], answers: list[Answer]
) -> None:
    lines = block({"inputs": inputs}, 0)
    marked = [f"{line}  # comment {index}." for index, line in enumerate(lines)]
    text = f"{SIM}{chr(10).join(marked)}\nsticks: {{expo: 0.4}}  # the last line\n"
    try:
        checked_profile(text, "rig.yaml")
    except DocumentError as error:
        raise AssertionError(f"the test's own profile does not load: {error}") from None
    done = profile_of(text, *answers)
    assert done.startswith(SIM)
    assert done.endswith("sticks: {expo: 0.4}  # the last line\n")
    learned = {answer.found.name for answer in answers}
    kept = [line for line, new in zip(marked, lines, strict=True) if _stays(new, answers, learned)]
    assert [line for line in kept if line not in done.splitlines()] == []
    assert _comments(done) <= _comments(text), "none is made up but the one of a new device"


def _stays(line: str, answers: list[Answer], learned: set[str]) -> bool:
    """Whether nothing that was learned has to do with this line."""
    name = line.split(":")[0].strip(" -")
    if name in ("device", "controls", "Dial", "Hat switch", "inputs"):
        return name in ("inputs", "controls", "device") or (name == "Dial" and not _asks(answers, dial=True))
    action = parse_document(line.strip(), "line").data[name]
    return (
        name not in learned
        and not any(answer.question.is_answered_by(action) for answer in answers)
        and (name not in ("up", "left"))
    )


def _asks(answers: list[Answer], dial: bool) -> bool:
    return any(answer.question.dial is dial for answer in answers)


def _comments(text: str) -> set[str]:
    return set(re.findall(r"# comment \d+\.", text))


def test_the_data_that_was_given_is_not_changed() -> None:
    inputs = [{"controls": {"X": {"axis": "pan"}}}]
    before = copy.deepcopy(inputs)
    merged(inputs, Answers([Answer(ASKED[0], 0, Found("Y", Kind.STICK, 1))]), [INFO], [HATS])
    assert inputs == before
