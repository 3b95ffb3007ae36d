"""The schemas for editors: an independent validator accepts what is shipped, and refuses what `check` refuses."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from command import teleop
from jsonschema import Draft202012Validator

from teleop.document import DocumentError
from teleop.profile import Profile
from teleop.schema import KINDS, schema
from teleop.shipped import folder
from teleop.sources.sequence_rules import file_rules
from teleop.sources.sequence_section import SequenceSection
from teleop.yaml_text import parse_document

SHIPPED = [
    (kind, file)
    for kind, where in (("sequence", "sequences"), ("profile", "profiles"), ("pad", "profiles/pads"))
    for file in sorted(folder(where).glob("*.yaml"))
]


def errors(kind: str, text: str) -> list[str]:
    data = parse_document(text, "f.yaml").data
    return [error.message for error in Draft202012Validator(schema(kind)).iter_errors(data)]


@pytest.mark.parametrize("kind", KINDS)
def test_it_is_a_schema_and_knows_no_more_keys_than_it_names(kind: str) -> None:
    made = schema(kind)
    Draft202012Validator.check_schema(made)
    assert made["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    for part in (made, *made["$defs"].values()):
        if "properties" in part:
            assert part["additionalProperties"] is False, part


@pytest.mark.parametrize(("kind", "file"), SHIPPED, ids=lambda each: each if isinstance(each, str) else each.stem)
def test_every_shipped_file_is_valid(kind: str, file: Path) -> None:
    assert errors(kind, file.read_text()) == []


def undescribed(kind: str) -> Iterator[str]:
    made = schema(kind)
    for name, part in {"": made, **made["$defs"]}.items():
        for key, of_key in part.get("properties", {}).items():
            if "description" not in of_key and "$ref" not in of_key:
                yield f"{name}.{key}"


def test_an_editor_can_say_what_each_key_of_a_sequence_is() -> None:
    assert list(undescribed("sequence")) == []


def test_the_words_come_from_the_docstrings() -> None:
    properties: dict[str, Any] = schema("sequence")["$defs"]["Keyframe"]["properties"]
    assert properties["pass"]["description"] == "Through, or stop there."
    assert properties["stick_yaw"]["description"] == "A drone's, -1..1, beginning and ending at 0."
    assert properties["pass"]["enum"] == ["through", "stop"]


RIGHT = [
    "keyframes: [{at: 0, pan: 1}]",
    "keyframes: [{at: '4s', pan: 1}, {at: 1m30s, tilt: 2}, {at: 2h, roll: 1, hold: 12f}]\nfps: 24",
    "fps: 25\nkeyframes: [{at: 00:00:04:00, focus: 0.5, pass: stop, ease: 25%}]",
    "ease: {arrive: soft, leave: 2s}\nkeyframes: [{at: 0, pan: 1, ease: 1.5}]",
    "keyframes: [{at: 0, stick_yaw: 0}]\ncues: [{at: 0, send: camera status}, {at: 1, follow: pan}]",
    "include: [{move: reveal, at: 1, speed: 12.5%}]",
    "timelapse: {frames: 9, interval: {from: 2s, to: 12s}, exposure: 1, settle: {below: 0.1, at_most: 2s}}\n"
    "keyframes: [{at: 8f, pan: 1}]",
]
WRONG = [
    "title: nothing",
    "keyframes: []",
    "keyframes: [{pan: 1}]",
    "keyframes: [{at: 1}]",
    "keyframes: [{at: soon, pan: 1}]",
    "keyframes: [{at: -1, pan: 1}]",
    "keyframes: [{at: true, pan: 1}]",
    "keyframes: [{at: 4 s, pan: 1}]",
    "keyframes: [{at: 00:61:00:00, pan: 1}]",
    "keyframes: [{at: 0, pna: 1}]",
    "keyframes: [{at: 0, pan: '1'}]",
    "keyframes: [{at: 0, focus: 1.1}]",
    "keyframes: [{at: 0, stick_roll: -2}]",
    "keyframes: [{at: 0, pan: 1, pass: by}]",
    "keyframes: [{at: 0, pan: 1, ease: gently}]",
    "keyframes: [{at: 0, pan: 1, ease: {arive: 1s}}]",
    "keyframes: [{at: 0, pan: 1}]\nfps: 0",
    "keyframes: [{at: 0, pan: 1}]\ntension: 2",
    "keyframes: [{at: 0, pan: 1}]\nfit: shrink",
    "keyframes: [{at: 0, pan: 1}]\nback_to_one: 1",
    "keyframes: [{at: 0, pan: 1}]\nrepeat: {times: 1.5, mode: loop}",
    "keyframes: [{at: 0, pan: 1}]\nrepeat: {times: 2, mode: round}",
    "keyframes: [{at: 0, pan: 1}]\ncues: [{at: 0}]",
    "keyframes: [{at: 0, pan: 1}]\ncues: [{at: 0, camera: record, follow: lock}]",
    "keyframes: [{at: 0, pan: 1}]\ncues: [{at: 0, camera: rec}]",
    "keyframes: [{at: 0, pan: 1}]\ncues: [{at: 0, recenter: now}]",
    "keyframes: 3",
    "include: [{move: reveal}]",
    "include: [{move: reveal, at: 0, speed: 2}]",
    "panorama: {fov: [54], pan: [0, 9], tilt: [0, 9], every: 3s}",
    "panorama: {fov: [54, 0], pan: [0, 9], tilt: [0, 9], every: 3s}",
    "panorama: {fov: [54, 38], pan: [0, 9], tilt: [0, 9], every: 3s, overlap: 30}",
    "timelapse: {frames: 0, interval: 2s, exposure: 1}\nkeyframes: [{at: 0, pan: 1}]",
    "timelapse: {frames: 9, interval: {from: 2s}, exposure: 1}\nkeyframes: [{at: 0, pan: 1}]",
]


def is_refused(text: str) -> bool:
    document = parse_document(text, "f.yaml")
    try:
        document.check(SequenceSection, file_rules(document.data))
    except DocumentError:
        return True
    return False


@pytest.mark.parametrize("text", RIGHT)
def test_what_is_right_is_accepted_by_both(text: str) -> None:
    assert errors("sequence", text) == []
    assert not is_refused(text)


@pytest.mark.parametrize("text", WRONG)
def test_what_is_wrong_is_refused_by_both(text: str) -> None:
    assert errors("sequence", text)
    assert is_refused(text)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("min: -180, max: 180", "min: null, max: null"),
        ("rate: 50", "rate: 50, delay: 0.05, signs: {pan: -1}, mapping: {yaw: pan, pitch: tilt}"),
        ("name: Sim", "presets: {recall: 3s}\nsticks: {expo: 0.2}\ninputs: [{device: any, pad: xbox}]\nname: Sim"),
    ],
)
def test_a_profile_may_say_all_that_it_may(old: str, new: str) -> None:
    text = (folder("profiles") / "sim.yaml").read_text()
    assert old in text
    assert errors("profile", text.replace(old, new, 1)) == []


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("name: Sim", "nmae: Sim"),
        ("velocity: 120", "velocity: 0"),
        ("velocity: 120, ", ""),
        ("pan: ", "pna: "),
        ("mode: position", "mode: direct"),
        ("rate: 50", "rate: 60"),
        ("type: gimbal", "type: crane"),
        ("type: gimbal, ", ""),
        ("rate: 50", "rate: 50, delay: 3"),
        ("name: Sim", "presets: {recall: soon}\nname: Sim"),
        ("name: Sim", "inputs: [{device: every}]\nname: Sim"),
    ],
)
def test_a_wrong_profile_is_refused_by_both(old: str, new: str) -> None:
    text = (folder("profiles") / "sim.yaml").read_text()
    assert old in text
    wrong = text.replace(old, new, 1)
    assert errors("profile", wrong)
    with pytest.raises(DocumentError):
        parse_document(wrong, "f.yaml").check(Profile)


def test_the_command_prints_it() -> None:
    done = teleop("schema", "sequence")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == json.loads(json.dumps(schema("sequence")))
    wrong = teleop("schema", "sequences")
    assert wrong.returncode == 2
    assert "sequence" in wrong.stderr
