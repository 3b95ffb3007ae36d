"""Sequence files as texts, loaded for a rig that is nothing but limits."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

import pytest

from teleop.config.documents.document import DocumentError
from teleop.core.axes import Axis, Limits
from teleop.sequence.compile import CompiledSequence, load_sequence

STICK = Limits(-1, 1, 2, 8, 40)
LIMITS = {
    Axis.PAN: Limits(-180, 180, 120, 240, 1200),
    Axis.TILT: Limits(-56, 146, 90, 180, 900),
    Axis.FOCUS: Limits(0, 1, 0.5, 2, 10),
}
RIGS = {"fly-by": "sim-drone"}  # of shipped sequences that the simulated rig cannot play
FLYING = {**LIMITS, Axis.STICK_THROTTLE: STICK, Axis.STICK_YAW: STICK}


def load(folder: Path, text: str, devices: Collection[str] | None = None) -> CompiledSequence:
    file = folder / "shoot.yaml"
    file.write_text(text)
    return load_sequence(str(file), FLYING if "stick_" in text else LIMITS, "the rig", devices)


def problems_of(
    folder: Path, text: str, kind: type[DocumentError] = DocumentError, devices: Collection[str] | None = None
) -> list[str]:
    """The lines for what is wrong with it, without the folder."""
    with pytest.raises(DocumentError) as caught:
        load(folder, text, devices)
    assert type(caught.value) is kind, caught.value.problems
    return [problem.replace(f"{folder}/", "") for problem in caught.value.problems]
