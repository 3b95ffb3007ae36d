"""Changes values in a YAML text and leaves everything else as it is, byte for byte: comments, order, line ends.

The text is composed to nodes, whose places say where a value or a key begins and ends; only what differs between the
old and the new data is written. The result is loaded again: a text that cannot be changed so (a value that an alias
repeats) is an error and no surprise.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from itertools import pairwise
from typing import Any, NamedTuple

import yaml

from teleop.config.documents.document import DocumentError, Location
from teleop.config.documents.list_pairs import pairing
from teleop.config.documents.yaml_loader import MAX_DEPTH, MAX_NODES, parse_document
from teleop.config.documents.yaml_nodes import compose

_PLAIN = re.compile(r"[A-Za-z][\w+*/-]*(?: [\w()+*/-]+)*")  # a word or several, which no rule of YAML reads otherwise
_WORDS = frozenset({"true", "false", "null"})
_INDENT = 2


class Hexadecimal(int):
    """A number that is written as `0x046d`."""


class Commented(dict[str, Any]):
    """A mapping with a comment behind it, where it is new."""

    comment = ""


class _Edit(NamedTuple):
    """A value for `path`. `delete`: its entry goes. `insert`: it goes before the entry of a list that is there now.

    A path behind the end of a list appends to it.
    """

    path: Location
    value: Any = None
    delete: bool = False
    insert: bool = False


def edited(text: str, data: Any, name: str) -> str:
    """`text` changed so that it holds `data`. Raises DocumentError where that cannot be done, `name` in front."""
    mark = "\ufeff" if text.startswith("\ufeff") else ""
    text = text[len(mark) :]
    for edit in _differences(parse_document(text, name).data, data, ()):
        text = _applied(text, edit)
    try:
        done = parse_document(text, name).data == data
    except DocumentError:
        done = False
    if not done:
        raise DocumentError([f"{name}: cannot be updated, because of an alias or its layout: write a new file with -o"])
    return mark + text


def flow(value: Any) -> str:
    """A value in one line."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{flow(key)}: {flow(each)}" for key, each in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(flow, value)) + "]"
    if isinstance(value, Hexadecimal):
        return f"{int(value):#06x}"
    if isinstance(value, str) and _PLAIN.fullmatch(value) and value.casefold() not in _WORDS:
        return value
    return json.dumps(value, ensure_ascii=False)


def block(value: Any, indent: int) -> list[str]:
    """A value in lines: mappings that hold only plain values are one line."""
    space = " " * indent
    if isinstance(value, Mapping):
        return [line for key, each in value.items() for line in _entry(key, each, indent)]
    lines = []
    for each in value:
        inner = block(each, indent + _INDENT) if _is_large(each) else [f"{space}{' ' * _INDENT}{flow(each)}"]
        lines += [f"{space}- {inner[0][indent + _INDENT :]}", *inner[1:]]
    return lines


def _entry(key: str, value: Any, indent: int) -> list[str]:
    space = " " * indent
    if _is_large(value):
        return [f"{space}{flow(key)}:", *block(value, indent + _INDENT)]
    comment = f"  # {value.comment}" if isinstance(value, Commented) and value.comment else ""
    return [f"{space}{flow(key)}: {flow(value)}{comment}"]


def _is_large(value: Any) -> bool:
    """Whether it takes several lines: it holds more than plain values."""
    inner = value.values() if isinstance(value, Mapping) else value if isinstance(value, list) else ()
    return any(isinstance(each, Mapping | list) for each in inner)


def _differences(old: Any, new: Any, path: Location) -> Iterator[_Edit]:
    """Edits in an order in which each finds the text that it is for: new keys first, then those that go."""
    if old == new and type(old) is type(new):
        return
    if isinstance(old, dict) and isinstance(new, dict) and new and old:
        for key, value in new.items():
            if key in old:
                yield from _differences(old[key], value, (*path, key))
            else:
                yield _Edit((*path, key), value)
        yield from (_Edit((*path, key), delete=True) for key in old if key not in new)
    elif isinstance(old, list) and isinstance(new, list) and old and new:
        yield from _list_differences(old, new, path)
    elif old != new or isinstance(old, bool) != isinstance(new, bool):
        yield _Edit(path, new)


def _list_differences(old: Sequence[Any], new: Sequence[Any], path: Location) -> Iterator[_Edit]:
    """From the last entry to the first, so that the numbers of those before stay; those that are alike are matched."""
    alike = SequenceMatcher(None, list(map(repr, old)), list(map(repr, new)), autojunk=False).get_opcodes()
    for kind, first, end, new_first, new_end in reversed(alike):
        if kind == "equal":
            continue
        pairs = pairing(old[first:end], new[new_first:new_end])
        bounds = [(-1, -1), *pairs, (end - first, new_end - new_first)]
        for (before, new_before), (after, new_after) in reversed(list(pairwise(bounds))):
            at, added = first + after, new[new_first + new_before + 1 : new_first + new_after]
            if at == len(old):
                yield from (_Edit((*path, at + index), value) for index, value in enumerate(added))
            else:
                yield from (_Edit((*path, at), value, insert=True) for value in reversed(added))
            yield from (_Edit((*path, index), delete=True) for index in reversed(range(first + before + 1, at)))
            if before >= 0:
                yield from _differences(old[first + before], new[new_first + new_before], (*path, first + before))


def _applied(text: str, edit: _Edit) -> str:
    node = compose(text, MAX_DEPTH, MAX_NODES)
    parent, key_node = None, None
    for step in edit.path[:-1]:
        node = child(node, step)[1]
    if edit.path:
        parent = node
        key_node, node = child(parent, edit.path[-1])
    if edit.delete:
        return _without(text, parent, edit.path[-1])
    if node is None or edit.insert:
        return _with_new(text, parent, edit.path[-1], edit.value)
    return _with_value(text, parent, key_node, node, edit.value)


def child(node: Any, step: str | int) -> tuple[Any, Any]:
    """The key and the value below a node; None for one that is not there."""
    if isinstance(node, yaml.MappingNode):
        return next(((key, value) for key, value in node.value if key.value == step), (None, None))
    if isinstance(node, yaml.SequenceNode) and isinstance(step, int) and step < len(node.value):
        return None, node.value[step]
    return None, None


def _with_value(text: str, parent: Any, key: Any, node: Any, value: Any) -> str:
    """With another value in place of the node's."""
    begin, end = node.start_mark.index, _end(node)
    in_line = key is not None and key.start_mark.line == node.start_mark.line == node.end_mark.line
    if key is not None and in_line and _is_large(value) and not parent.flow_style:
        behind = _line_end(text, end)
        lines = block(value, key.start_mark.column + _INDENT)
        kept = text[:begin].rstrip(" ") + text[end:behind]
        return kept + _joined(lines, text) + text[behind:]
    space = "" if text[begin - 1 : begin] in ("", " ", "\n", "{", "[") else " "
    return text[:begin] + space + flow(value) + text[end:]


def _with_new(text: str, parent: Any, key: str | int, value: Any) -> str:
    """With a new entry at the end of a mapping, or in a list before the entry `key`."""
    in_list = isinstance(parent, yaml.SequenceNode)
    if in_list and parent.value and key == 0:
        return _with_first(text, parent, value)
    before = parent.value[int(key) - 1 if in_list else -1] if parent.value else None
    if parent.flow_style or not parent.value:
        entry = flow(value) if in_list else f"{flow(key)}: {flow(value)}"
        at = _end_of_entry(before) if before else parent.end_mark.index - 1
        return text[:at] + (", " if parent.value else "") + entry + text[at:]
    first = parent.value[0] if in_list else parent.value[0][0]
    column = parent.start_mark.column if in_list else first.start_mark.column
    lines = block([value], column) if in_list else _entry(str(key), value, column)
    at = _end_of_entry(before)
    if text[at - 1 : at] == "\n":  # behind a block scalar
        return text[:at] + _joined(lines, text).removeprefix(_break(text)) + _break(text) + text[at:]
    at = _line_end(text, at)
    return text[:at] + _joined(lines, text) + text[at:]


def _with_first(text: str, parent: Any, value: Any) -> str:
    """With a new entry before the first one of a list."""
    begin = _begin(text, parent, 0)
    if parent.flow_style:
        return f"{text[:begin]}{flow(value)}, {text[begin:]}"
    column = parent.start_mark.column
    lines = _joined(block([value], column), text).removeprefix(_break(text)).lstrip(" ")
    return f"{text[:begin]}{lines}{_break(text)}{' ' * column}{text[begin:]}"


def _begin(text: str, parent: Any, index: int) -> int:
    """Where an entry begins: of a block's list at its dash."""
    entry = parent.value[index]
    if not isinstance(parent, yaml.SequenceNode):
        return entry[0].start_mark.index
    begin = entry.start_mark.index
    return begin if parent.flow_style else text.rindex("-", 0, begin)


def _without(text: str, parent: Any, key: str | int) -> str:
    """Without an entry of a mapping or a list that has others."""
    in_list = isinstance(parent, yaml.SequenceNode)
    index = int(key) if in_list else next(i for i, (node, _) in enumerate(parent.value) if node.value == key)
    begin, end = _begin(text, parent, index), _end_of_entry(parent.value[index])
    line = text.rfind("\n", 0, begin) + 1
    if not parent.flow_style and not text[line:begin].strip():
        behind = end if text[end - 1 : end] == "\n" else _line_end(text, end) + len(_break(text))
        return text[:line] + text[behind:]
    if index + 1 < len(parent.value):
        return text[:begin] + text[_begin(text, parent, index + 1) :]
    return text[: _end_of_entry(parent.value[index - 1])] + text[end:]


def _end(node: Any) -> int:
    """Where a node's own text ends: a block's node ends only where the next one begins."""
    if isinstance(node, yaml.CollectionNode) and not node.flow_style and node.value:
        return _end_of_entry(node.value[-1])
    return node.end_mark.index


def _end_of_entry(entry: Any) -> int:
    return max(map(_end, entry)) if isinstance(entry, tuple) else _end(entry)


def _line_end(text: str, at: int) -> int:
    found = re.compile(r"\r?\n|\r|\Z").search(text, at)
    return found.start() if found else len(text)


def _break(text: str) -> str:
    found = re.search(r"\r\n|\n|\r", text)
    return found[0] if found else "\n"


def _joined(lines: Sequence[str], text: str) -> str:
    return "".join(f"{_break(text)}{line}" for line in lines)
