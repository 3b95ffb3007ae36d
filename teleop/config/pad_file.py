"""A pad's mapping as a file: shipped with the program, or the user's own."""

from __future__ import annotations

from teleop.config.documents.yaml_loader import read_document
from teleop.config.file_kinds import refuse_other_kind
from teleop.config.inputs_section import PADS, PadSection, control_rules
from teleop.config.resources import find


def load_pad(name: str) -> PadSection:
    """A shipped mapping, or one at a path; raises DocumentError with a line for everything wrong with it."""
    document = read_document(*find(name, PADS, "pad"))
    refuse_other_kind(document, "pad")
    data = document.data if isinstance(document.data, dict) else {}
    controls = data.get("controls")
    return document.check(
        PadSection, control_rules(controls if isinstance(controls, dict) else {}, ("controls",), None)
    )
