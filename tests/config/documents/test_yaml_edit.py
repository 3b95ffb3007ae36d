"""Values changed in a YAML text: the text holds the new ones, and everything else is as it was."""

from __future__ import annotations

import copy
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from teleop.config.documents.document import DocumentError
from teleop.config.documents.yaml_edit import Commented, Hexadecimal, block, edited, flow
from teleop.config.documents.yaml_loader import parse_document

RIG = """\
# My rig.
name: R   # its name
inputs:
  # the pad
  - device: any   # d
    controls:   # c
      X:      # x
        axis: pan  # p
        expo: 0.5

      Y: {axis: tilt, expo: 0.3}  # y
      # between
      Z: {axis: roll}
  # after
axes: {pan: 1}  # last
"""


def loaded(text: str) -> Any:
    return parse_document(text.removeprefix("\ufeff"), "rig.yaml").data


def test_only_what_differs_is_written() -> None:
    data = loaded(RIG)
    controls = data["inputs"][0]["controls"]
    controls["X"]["invert"] = True
    controls["Y"]["expo"] = 0.4
    del controls["Z"]
    controls["joystick 2: X"] = {"axis": "roll"}
    controls["Hat switch"] = {"up": {"press": "stop"}}
    expected = RIG.replace("        expo: 0.5\n", "        expo: 0.5\n        invert: true\n").replace("0.3}", "0.4}")
    added = '      "joystick 2: X": {axis: roll}\n      Hat switch:\n        up: {press: stop}\n'
    assert edited(RIG, data, "rig.yaml") == expected.replace("      Z: {axis: roll}\n", added)


PAD = Commented(vendor=Hexadecimal(0x46D))
PAD.comment = "Pad"
ENTRY = [{"device": PAD, "controls": {"X": {"axis": "pan"}}}]
NL = "\n"
LINES = "  - device: {vendor: 0x046d}  # Pad\n    controls:\n      X: {axis: pan}"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("name: a\n", f"name: a\ninputs:\n{LINES}\n"),
        ("name: a", f"name: a\ninputs:\n{LINES}"),
        ("name: a\ninputs: []  # none\nb: 1\n", f"name: a\ninputs:  # none\n{LINES}\nb: 1\n"),
        ("name: a\ninputs:   # why\nb: 2\n", f"name: a\ninputs:   # why\n{LINES}\nb: 2\n"),
        ("{name: a}", "{name: a, inputs: [{device: {vendor: 0x046d}, controls: {X: {axis: pan}}}]}"),
        ("\ufeffa: |\r\n  x\r\n", f"\ufeffa: |\n  x\ninputs:\n{LINES}\n".replace("\n", "\r\n")),
        ("inputs:\n- device: any\nb: 1\n", f"inputs:\n- device: any\n{LINES.replace(NL + '  ', NL)[2:]}\nb: 1\n"),
    ],
    ids=["end", "no line end", "empty list", "nothing", "flow", "Windows", "dashes at the edge"],
)
def test_a_new_list_or_entry_wherever_it_goes(text: str, expected: str) -> None:
    data = loaded(text)
    data["inputs"] = [*(data.get("inputs") or []), *ENTRY]
    assert edited(text, data, "rig.yaml") == expected
    assert loaded(expected) == data


def test_all_keys_of_a_mapping_are_replaced_in_its_own_style() -> None:
    text = "a:\n  - b: 1   # old\n    c: {d: 2}\n  # end\n"
    assert edited(text, {"a": [{"x": 3}]}, "rig.yaml") == "a:\n  - x: 3\n  # end\n"
    assert edited(text, {"a": [{"b": 1, "c": {"e": 4}}]}, "rig.yaml") == text.replace("d: 2", "e: 4")


@pytest.mark.parametrize(
    ("text", "gone", "expected"),
    [
        ("a:\n  # one\n  - b: 1\n    c: 2  # two\n  # three\n  - d\n", 0, "a:\n  # one\n  # three\n  - d\n"),
        ("a:\n  - b\n  - {c: 1}  # gone with it\nd: 1  # stays\n", 1, "a:\n  - b\nd: 1  # stays\n"),
        ("a:\n- b\n- c\n- d", 2, "a:\n- b\n- c\n"),
        ("a: [b, {c: 1}, d]  # stays\n", 1, "a: [b, d]  # stays\n"),
        ("a: [b, c]\n", 1, "a: [b]\n"),
    ],
    ids=["several lines", "one line", "the last of the text", "flow", "the last of flow"],
)
def test_an_entry_of_a_list_is_removed_and_the_others_stay(text: str, gone: int, expected: str) -> None:
    data = loaded(text)
    del data["a"][gone]
    assert edited(text, data, "rig.yaml") == expected
    assert loaded(expected) == data


def test_several_entries_are_removed_at_once_and_one_that_is_another_is_written_anew() -> None:
    text = "a:\n  - b  # 0\n  - c  # 1\n  - b  # 2\n  - d  # 3\n"
    assert edited(text, {"a": ["c", "d"]}, "rig.yaml") == "a:\n  - c  # 1\n  - d  # 3\n"
    assert loaded(edited(text, {"a": ["d", "c"]}, "rig.yaml")) == {"a": ["d", "c"]}


def test_what_an_alias_repeats_is_not_changed_behind_its_back() -> None:
    text = "a: &x {b: 1}\nc: *x\n"
    with pytest.raises(DocumentError, match="cannot be updated, because of an alias"):
        edited(text, {"a": {"b": 2}, "c": {"b": 1}}, "rig.yaml")


names = st.sampled_from(["X", "Y", "Slider 2", "joystick 2: Hat switch", "Key non-US #", "true", "- a", "é", "'", '"'])
plain = st.one_of(st.booleans(), st.none(), st.integers(-9, 9), st.sampled_from([0.25, -1.5]), names)
values = st.recursive(
    plain,
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(names, inner, max_size=3)),
    max_leaves=6,
)
mappings = st.dictionaries(names, values, max_size=4)


def commented(lines: list[str]) -> str:
    """These lines with a comment above and behind each."""
    return "".join(f"# above {index}\n{line}  # at {index}\n" for index, line in enumerate(lines))


@settings(max_examples=60, deadline=None)
@given(old=mappings, new=mappings)
def test_whatever_becomes_of_one_key_the_others_keep_their_bytes(old: dict[str, Any], new: dict[str, Any]) -> None:
    before, after = commented(["name: R", "version: 2"]), commented(["sinks: [a, b]  ", "last: {x: 1}"])
    text = before + commented(block({"inputs": old}, 0)) + after
    data = copy.deepcopy(loaded(text))
    data["inputs"] = new
    done = edited(text, data, "rig.yaml")
    assert loaded(done) == data
    assert done.startswith(before)
    assert done.endswith(after)


@settings(max_examples=60, deadline=None)
@given(value=values)
def test_a_value_in_one_line_is_that_value(value: Any) -> None:
    assert loaded(f"a: {flow(value)}\n") == {"a": value}


KEYS = """\
keyframes:
  # the door
  - {at: 0, pan: 0}   # start
  # the window
  - at: 2s            # w
    pan: 10
    tilt: 1

  # the end
  - {at: 5, pan: 20}  # stop
fit: stretch
"""


def changed(text: str, change: Any) -> str:
    data = loaded(text)
    change(data["keyframes"])
    return edited(text, data, "m.yaml")


def test_an_entry_taken_from_a_list_takes_no_comment_of_another() -> None:
    without = KEYS.replace("  - at: 2s            # w\n    pan: 10\n    tilt: 1\n", "")
    assert changed(KEYS, lambda keys: keys.pop(1)) == without
    assert changed(KEYS, lambda keys: keys.pop(0)) == KEYS.replace("  - {at: 0, pan: 0}   # start\n", "")
    assert changed(KEYS, lambda keys: keys.pop(2)) == KEYS.replace("  - {at: 5, pan: 20}  # stop\n", "")


def test_an_entry_put_into_a_list_moves_the_others_as_they_are() -> None:
    new = {"at": 1, "pan": 5}
    after_first = KEYS.replace("# start\n", "# start\n  - {at: 1, pan: 5}\n")
    assert changed(KEYS, lambda keys: keys.insert(1, new)) == after_first
    first = KEYS.replace("  - {at: 0", "  - {at: 1, pan: 5}\n  - {at: 0")
    assert changed(KEYS, lambda keys: keys.insert(0, new)) == first
    two = KEYS.replace("# stop\n", "# stop\n  - {at: 1, pan: 5}\n  - {at: 1, pan: 5}\n")
    assert changed(KEYS, lambda keys: keys.extend([new, dict(new)])) == two


def test_a_changed_entry_keeps_its_own_comment() -> None:
    def drag(keys: list[Any]) -> None:
        keys[1]["pan"] = 12.5

    assert changed(KEYS, drag) == KEYS.replace("pan: 10", "pan: 12.5")


FRAMES = st.lists(st.fixed_dictionaries({"at": st.integers(0, 9)}, optional={"pan": st.integers(-9, 9)}), max_size=6)


@settings(max_examples=150)
@given(FRAMES, FRAMES, st.booleans())
def test_any_list_becomes_any_other(old: list[Any], new: list[Any], in_flow: bool) -> None:
    text = f"keyframes: {flow(old)}\n" if in_flow or not old else "\n".join(block({"keyframes": old}, 0)) + "\n"
    assert loaded(edited(f"# a\n{text}# z\n", {"keyframes": new}, "m.yaml")) == {"keyframes": new}
