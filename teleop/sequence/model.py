"""What may stand in a sequence file, as pydantic sections; what must hold between the values is `sequence_rules`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import AfterValidator, ConfigDict, Field

from teleop.config.documents.base_model import Finite, PositionsSection, Section
from teleop.config.documents.json_types import Ease, Overshoot, Percentage, TensionWritten, Time
from teleop.config.frame_rates import exact_rate
from teleop.core.axes import Axis
from teleop.core.plain import plain
from teleop.planner.keyframes.repeat import Repeat
from teleop.planner.keyframes.tension import EVEN
from teleop.sequence.aim_section import Aim, CameraMountSection, Mount, OffsetSection, Place
from teleop.sequence.cues import CueSection
from teleop.sequence.panorama import PanoramaSection
from teleop.sequence.tables.section import SourceSection
from teleop.sequence.timelapse_section import TimelapseSection

PREROLL = 0.5  # s at rest on the first keyframe before the start, unless the file says otherwise
LONGEST_TITLE = 200  # characters: it stands in a line of the screen

Deflection = Annotated[Finite, Field(ge=-1, le=1)]


def one_of(*names: str) -> ConfigDict:
    """For a section that needs one of these keys: what a schema is to say of it."""
    return ConfigDict(json_schema_extra={"anyOf": [{"required": [name]} for name in names]})


class Keyframe(PositionsSection):
    """Where some axes are at a time; an axis that is not named has no key here."""

    model_config = one_of(*(axis.value for axis in Axis), "aim", "base")

    at: Time
    """Time from the start: `4`, `4s`, `1m30s`; with `fps` also `96f`, `00:00:04:00`. In a timelapse: frames."""
    hold: Time = 0
    """How long the axes stay here: `2s`."""
    focus: Annotated[Finite, Field(ge=0, le=1)] | None = None
    """Focus, 0 (near) to 1 (far)."""
    stick_roll: Deflection | None = None
    """Right stick of the drone sideways, -1 to 1; + is right. 0 in its first and last key."""
    stick_pitch: Deflection | None = None
    """Right stick of the drone forward, -1 to 1; + is forward. 0 in its first and last key."""
    stick_throttle: Deflection | None = None
    """Left stick of the drone up, -1 to 1; + is up. 0 in its first and last key."""
    stick_yaw: Deflection | None = None
    """Left stick of the drone sideways, -1 to 1; + is clockwise. 0 in its first and last key."""
    aim: Aim = None
    """Look at a target by its name, or at a point `[x, y, z]` in m; gives pan and tilt."""
    offset: OffsetSection | None = None
    """How far beside its target it looks."""
    base: Place = None
    """Where the slider or dolly below the rig is: `[x, y, z]` in m. It moves evenly from key to key."""
    pass_: Literal["through", "stop"] = Field("through", alias="pass")
    """Pass through this key, or stop at it."""
    through: Literal["shortest"] | None = None
    """`shortest`: an axis without ends goes to this key the short way round."""
    ease: Ease = None
    """Ramps to a stop here and away from it: `2s`, `25%`, `soft`, `{arrive: 1s, leave: 3s}`."""


class IncludeSection(Section):
    """Another sequence within this one."""

    move: Annotated[str, Field(min_length=1)]
    """Name of a shipped sequence, or a file beside this one."""
    at: Time
    """Time at which it begins here."""
    speed: Percentage = "100%"
    """Playback speed: `150%`."""


class RepeatSection(Section):
    """Play the keyframes several times."""

    times: Annotated[int, Field(ge=1, le=10_000)]
    """Number of passes; a bounce counts the way there and the way back as two."""
    mode: Annotated[Repeat, Field(strict=False)]
    """`loop` begins again where the move ended, `bounce` goes back."""


class SequenceModel(Section):
    """A camera move."""

    model_config = one_of("keyframes", "panorama", "include", "source")

    title: Annotated[str, Field(max_length=LONGEST_TITLE)] = ""
    """Title on screens."""
    fps: Annotated[float, Field(gt=0, le=1000), AfterValidator(exact_rate)] | None = None
    """Frames per second of frames and timecode; 23.976, 29.97 and 59.94 are exactly n/1001."""
    tension: TensionWritten = EVEN
    """0 is smoothest, 1 closest to constant speed; `even` is smooth, and even between keys that are passed through."""
    overshoot: Overshoot = None
    """How far an axis may pass two keys between them where its limits force it to, in its units: `2`, `{pan: 2}`."""
    through: Literal["shortest"] | None = None
    """`shortest`: axes without ends go the short way round to every key."""
    ease: Ease = None
    """Ramps at every stop that has none of its own."""
    fit: Literal["stretch"] | None = None
    """`stretch` slows a move that is too fast for the rig."""
    preroll: Time = PREROLL
    """Rest on the first key before the start: `3s`."""
    back_to_one: bool = False
    """Go back to the first key at the end."""
    repeat: RepeatSection | None = None
    """Play the keyframes several times."""
    targets: dict[str, Place] = Field(default_factory=dict)
    """Points to aim at by name: `door: [4.0, 1.2, 1.6]`, m from the mount: x right, y forward, z up."""
    mount: Mount = CameraMountSection()
    """Height of the camera in m above the point that targets are measured from."""
    timelapse: TimelapseSection | None = None
    """Shoot frame by frame; the times of keyframes are then output frames."""
    keyframes: Annotated[list[Keyframe], Field(min_length=1)] = Field(default_factory=list)
    """Where the axes are, and when; each entry starts with `- `."""
    panorama: PanoramaSection | None = None
    """Rows and columns of stills."""
    source: SourceSection | None = None
    """A table by the frame, as keys; all other times here then count from its first frame."""
    include: list[IncludeSection] = Field(default_factory=list)
    """Other sequences within this one."""
    cues: list[CueSection] = Field(default_factory=list)
    """What happens once at a time, beside the motion."""

    def overshoot_of(self, axis: Axis) -> float | None:
        """What the file tolerates of an axis, in its units; None for what is usual."""
        return self.overshoot.get(axis.value) if isinstance(self.overshoot, dict) else self.overshoot

    def goes_shortest(self, frame: int) -> bool:
        """Whether axes without ends go the short way to a keyframe, by its number from 0."""
        return "shortest" in (self.through, self.keyframes[frame].through)

    def called(self, file: str) -> str:
        """The title in one line, else the file's name without its ending."""
        return plain(" ".join(self.title.split()) or Path(file).stem)
