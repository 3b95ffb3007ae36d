"""The schemas for editors: an independent validator accepts what is shipped, and refuses what `check` refuses."""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from command import teleop
from jsonschema import Draft202012Validator

from teleop.app.json_schema import KINDS, schema
from teleop.config.documents.document import Document, DocumentError
from teleop.config.documents.yaml_loader import parse_document
from teleop.config.profile import Profile
from teleop.config.resources import folder
from teleop.sequence.model import SequenceModel
from teleop.sequence.rules import file_rules
from teleop.sequence.timeline import Timeline

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


def described(part: Any, path: str = "") -> Iterator[tuple[str, str]]:
    """Every key that the schema names, however deep, and its description."""
    if isinstance(part, list):
        for item in part:
            yield from described(item, path)
    if not isinstance(part, dict):
        return
    properties = part.get("properties", {})
    for key, of_key in properties.items():
        yield f"{path}.{key}", of_key.get("description", "")
        yield from described(of_key, f"{path}.{key}")
    for name, inner in part.items():
        if name == "$defs":
            for definition, of_definition in inner.items():
                yield from described(of_definition, definition)
        elif name not in ("properties", "examples", "default", "enum", "required"):
            yield from described(inner, path)


@pytest.mark.parametrize(("kind", "least"), [("sequence", 50), ("profile", 80), ("pad", 30)])
def test_every_key_of_every_kind_of_file_has_a_description(kind: str, least: int) -> None:
    found = list(described(schema(kind), kind))
    assert len(found) > least, "the walk must reach the keys"
    assert [path for path, text in found if not text.strip()] == []
    assert [path for path, text in found if not (text[:1].isupper() or text[:1] in "-0123456789`")] == []


def test_descriptions_are_the_docstrings_of_the_fields() -> None:
    properties: dict[str, Any] = schema("sequence")["$defs"]["Keyframe"]["properties"]
    assert properties["pass"]["description"] == "Pass through this key, or stop at it."
    assert properties["tilt"]["description"] == "Tilt in deg; + is up."
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
    "keyframes: [{at: 1e308, pan: 1}]",
    "keyframes: [{at: 0, pan: 1, ease: 60%}]",
    "keyframes: [{at: 0, pan: 1, hold: 1000000000}]",
    "panorama: {fov: [54, 38], pan: [0, 9], tilt: [0, 9], every: 3s, overlap: 91%}",
    "timelapse: {frames: 9, interval: 0, exposure: 0}\nkeyframes: [{at: 0, pan: 1}]",
    "panorama: {fov: [54], pan: [0, 9], tilt: [0, 9], every: 3s}",
    "panorama: {fov: [54, 0], pan: [0, 9], tilt: [0, 9], every: 3s}",
    "panorama: {fov: [54, 38], pan: [0, 9], tilt: [0, 9], every: 3s, overlap: 30}",
    "timelapse: {frames: 0, interval: 2s, exposure: 1}\nkeyframes: [{at: 0, pan: 1}]",
    "timelapse: {frames: 9, interval: {from: 2s}, exposure: 1}\nkeyframes: [{at: 0, pan: 1}]",
]


def is_refused(text: str) -> bool:
    document = parse_document(text, "f.yaml")
    try:
        document.check(SequenceModel, file_rules(document.data))
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


VALUES = """[
  0, 1, -1, 1.5, -0.0, 1e308, .inf, .nan, 0x10, null, true, [], {}, '', text, reveal, record, lock, operator, bounce,
  soft, smooth, stop, 3s, 4.5s, 1m30s, 2h, 1h2m3s, 1000000h, 96f, 0f, 00:01:00;02, 00:61:00:00, 12:30, '3', '4 s',
  '  3s ', 1e3s, ٣s, 5%, 50%, 50.1%, 60%, 90%, 91%, 100%, 100.00%, 500%, 030%, 30.5%, 30 %, [54, 38], [0, 90], [200, 3],
  [1], {arrive: 1s}, {arrive: soft, leave: 30%}, {arrive: x}, {from: 2s, to: 3s}, {from: 0, to: 3s},
  {below: 0.1, at_most: 2s},
]"""
KEYS = {
    "keyframes": ({"at": 0, "tilt": 1}, "at pan focus hold pass ease stick_yaw"),
    "cues": ({"at": 0}, "at camera follow recenter send wait"),
    "include": ({"move": "reveal", "at": 0}, "move at speed"),
    "panorama": (
        {"fov": [54, 38], "pan": [0, 90], "tilt": [0, 40], "every": 3},
        "fov overlap pan tilt every settle exposure at",
    ),
    "repeat": ({"times": 2, "mode": "loop"}, "times mode"),
    "timelapse": (
        {"frames": 9, "interval": 3, "exposure": 0.1},
        "frames interval exposure settle mode lead_in delay prefocus post",
    ),
    "": ({}, "title fps tension ease fit preroll back_to_one"),
}
"""Each section with what it needs, and what may stand in it."""


def documents(section: str) -> Iterator[dict[str, Any]]:
    """Sound ones, but for what stands at one key."""
    needed, keys = KEYS[section]
    for key, value in product(keys.split(), parse_document(VALUES, "values").data):
        given = {"at": 0, "camera": "stop"} if section == "cues" and key == "at" else needed
        of_section = {**given, key: value}
        data = {"fps": 29.97, "keyframes": [{"at": 0, "tilt": 1}]}
        listed = section in ("keyframes", "cues", "include")
        yield {**data, **(of_section if not section else {section: [of_section] if listed else of_section})}


@pytest.mark.parametrize("section", KEYS)
def test_whatever_stands_at_a_key_is_read_or_refused_and_no_editor_is_stricter(section: str) -> None:
    validator = Draft202012Validator(schema("sequence"))
    accepted = 0
    for data in documents(section):
        document = Document("f.yaml", data, dict.fromkeys([("cues", 0), ("keyframes", 0)], (1, 1)))
        try:
            sheet = document.check(SequenceModel, file_rules(data))
        except DocumentError:
            continue
        accepted += 1
        assert not list(validator.iter_errors(data)), data
        if sheet.timelapse is None:
            Timeline.of(document, sheet).own_blocks({})  # reads every value again, and raises nothing
    assert accepted > 2


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
