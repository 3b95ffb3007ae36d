"""Which kind of file a YAML file is, by its top-level keys: a profile given as a sequence is one error, not twenty."""

from __future__ import annotations

from collections.abc import Mapping

from teleop.config.documents.document import Document, DocumentError

MARKS: Mapping[str, frozenset[str]] = {
    "sequence": frozenset({"keyframes", "panorama", "include", "source"}),
    "profile": frozenset({"links", "axes", "sinks"}),
    "pad": frozenset({"devices", "controls"}),
}
"""Top-level keys that only this kind of file has."""
USE: Mapping[str, str] = {
    "sequence": "this is a sequence: give it to `teleop play`",
    "profile": "this is a profile: give it with --rig",
    "pad": "this is a pad: name it in a profile with `inputs: [{pad: ...}]`",
}


def kind_of(data: object) -> str:
    """`sequence`, `profile` or `pad`; "" where the keys are of none or of several kinds."""
    keys = data.keys() if isinstance(data, dict) else set()
    kinds = [kind for kind, marks in MARKS.items() if keys & marks]
    return kinds[0] if len(kinds) == 1 else ""


def refuse_other_kind(document: Document, kind: str) -> None:
    """Raise DocumentError, in one line, where the document is another kind of file than `kind`."""
    found = kind_of(document.data)
    if found and found != kind:
        raise DocumentError([document.problem((), USE[found])])
