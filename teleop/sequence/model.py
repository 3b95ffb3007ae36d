"""What may stand in a sequence file, as pydantic sections; what must hold between the values is `sequence_rules`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import AfterValidator, ConfigDict, Field

from teleop.config.base_model import Finite, PositionsSection, Section
from teleop.config.frame_rates import exact_rate
from teleop.config.json_types import Ease, Percentage, Time
from teleop.core.axes import Axis
from teleop.planner.keyframes.repeat import Repeat
from teleop.sequence.cues import CueSection
from teleop.sequence.panorama import PanoramaSection
from teleop.sequence.timelapse_section import TimelapseSection

PREROLL = 0.5  # s at rest on the first keyframe before the start, unless the file says otherwise
LONGEST_TITLE = 200  # characters: it stands in a line of the screen

Deflection = Annotated[Finite, Field(ge=-1, le=1)]


def one_of(*names: str) -> ConfigDict:
    """For a section that needs one of these keys: what a schema is to say of it."""
    return ConfigDict(json_schema_extra={"anyOf": [{"required": [name]} for name in names]})


class Keyframe(PositionsSection):
    """Where some axes are at a time; an axis that is not named has no key here.

    `at`: when, from the start. `hold`: how long the axes stay. `pass`: through, or stop there. `ease`: the ramps to a
    stop here and away from it. `pan`: deg, + is right. `tilt`: deg, + is up. `roll`: deg, + is clockwise seen from
    behind the camera. `focus`: 0 (near) .. 1 (far). `stick_roll`, `stick_pitch`, `stick_throttle`, `stick_yaw`: a
    drone's, -1..1, beginning and ending at 0.
    """

    model_config = one_of(*(axis.value for axis in Axis))

    at: Time
    hold: Time = 0
    focus: Annotated[Finite, Field(ge=0, le=1)] | None = None
    stick_roll: Deflection | None = None
    stick_pitch: Deflection | None = None
    stick_throttle: Deflection | None = None
    stick_yaw: Deflection | None = None
    pass_: Literal["through", "stop"] = Field("through", alias="pass")
    ease: Ease = None


class IncludeSection(Section):
    """Another sequence within this one.

    `move`: a shipped name, or a file beside this one. `at`: when it begins here. `speed`: how fast, 150%.
    """

    move: Annotated[str, Field(min_length=1)]
    at: Time
    speed: Percentage = "100%"


class RepeatSection(Section):
    """The keyframes over and over.

    `times`: passes; a bounce counts the way there and the way back as two. `mode`: loop begins again where it ended,
    bounce goes back.
    """

    times: Annotated[int, Field(ge=1, le=10_000)]
    mode: Annotated[Repeat, Field(strict=False)]


class SequenceModel(Section):
    """A camera move.

    `title`: what it is called on the screen. `fps`: what frames and timecode are counted by. `tension`: 0 is smoothest,
    1 closest to constant speed between keys. `ease`: the ramps at every stop that has none of its own. `fit`: what is
    too fast for the rig is stretched. `preroll`: the rest on the first keyframe before the start. `back_to_one`: at the
    end the axes go back to the first keyframe. `repeat`: the keyframes over and over. `timelapse`: the keyframes are in
    frames of a timelapse. `keyframes`: where the axes are when. `panorama`: rows and columns of stills. `include`:
    other sequences within this one. `cues`: what happens once, beside the motion.
    """

    model_config = one_of("keyframes", "panorama", "include")

    title: Annotated[str, Field(max_length=LONGEST_TITLE)] = ""
    fps: Annotated[float, Field(gt=0, le=1000), AfterValidator(exact_rate)] | None = None
    tension: Annotated[float, Field(ge=0, le=1)] = 0.0
    ease: Ease = None
    fit: Literal["stretch"] | None = None
    preroll: Time = PREROLL
    back_to_one: bool = False
    repeat: RepeatSection | None = None
    timelapse: TimelapseSection | None = None
    keyframes: Annotated[list[Keyframe], Field(min_length=1)] = Field(default_factory=list)
    panorama: PanoramaSection | None = None
    include: list[IncludeSection] = Field(default_factory=list)
    cues: list[CueSection] = Field(default_factory=list)

    def called(self, file: str) -> str:
        """The title in one line, else the file's name without its ending."""
        return " ".join(self.title.split()) or Path(file).stem
