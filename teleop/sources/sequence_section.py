"""What may stand in a sequence file, as pydantic sections; what must hold between the values is `sequence_rules`."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from teleop.planner.repeat import Repeat
from teleop.section import Finite, PositionsSection, Section
from teleop.sources.cues import CueSection
from teleop.sources.panorama import PanoramaSection
from teleop.sources.timelapse_section import TimelapseSection

PREROLL = 0.5  # s at rest on the first keyframe before the start, unless the file says otherwise

Deflection = Annotated[Finite, Field(ge=-1, le=1)]


class Keyframe(PositionsSection):
    """What stands in the file; `at`, `hold` and `ease` are as written, the axes' positions are in their units."""

    at: Any
    hold: Any = 0
    focus: Annotated[Finite, Field(ge=0, le=1)] | None = None
    stick_roll: Deflection | None = None
    stick_pitch: Deflection | None = None
    stick_throttle: Deflection | None = None
    stick_yaw: Deflection | None = None
    pass_: Literal["through", "stop"] = Field("through", alias="pass")
    ease: Any = None


class IncludeSection(Section):
    """Another sequence, from `at` on; `move` is a shipped name, or a file beside this one. `speed`: how fast, 150%."""

    move: Annotated[str, Field(min_length=1)]
    at: Any
    speed: Any = "100%"


class RepeatSection(Section):
    """`times` passes; a bounce counts the way there and the way back as two."""

    times: Annotated[int, Field(ge=1, le=10_000)]
    mode: Annotated[Repeat, Field(strict=False)]


class SequenceSection(Section):
    """`tension`: 0 is smoothest, 1 closest to constant speed between keys. `fit`: what is too fast is stretched.

    `ease`: the ramps at every stop that has none of its own. `preroll`: the rest on the first keyframe before the
    start. `back_to_one`: at the end the axes go back to the first keyframe.
    """

    title: str = ""
    fps: Annotated[float, Field(gt=0, le=1000)] | None = None
    tension: Annotated[float, Field(ge=0, le=1)] = 0.0
    ease: Any = None
    fit: Literal["stretch"] | None = None
    preroll: Any = PREROLL
    back_to_one: bool = False
    repeat: RepeatSection | None = None
    timelapse: TimelapseSection | None = None
    keyframes: Annotated[list[Keyframe], Field(min_length=1)] = Field(default_factory=list)
    panorama: PanoramaSection | None = None
    include: list[IncludeSection] = Field(default_factory=list)
    cues: list[CueSection] = Field(default_factory=list)
