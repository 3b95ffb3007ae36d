"""What `play` is asked of a timelapse, and of nothing else."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from cyclopts import Parameter

from teleop.config.documents.document import DocumentError


@Parameter(name="*")
@dataclass(frozen=True)
class ShootOptions:
    """Go on with a shoot, begin it anew, or try its move."""

    rehearse: Annotated[
        bool,
        Parameter(
            help="Play a timelapse's move at its clip's speed, without shutter.", negative=(), show_default=False
        ),
    ] = False
    resume: Annotated[
        bool, Parameter(help="Continue a timelapse where it stopped.", negative=(), show_default=False)
    ] = False
    restart: Annotated[
        bool,
        Parameter(help="Start a timelapse again at frame 1, and discard its journal.", negative=(), show_default=False),
    ] = False
    by_hand: Annotated[
        bool,
        Parameter(
            help="Shoot a timelapse frame by frame, each with Enter; arrow keys go to the next and the previous frame.",
            negative=(),
            show_default=False,
        ),
    ] = False
    in_doubt: Annotated[
        Literal["shoot", "skip"],
        Parameter(help="With --resume, a frame that may be missing: shoot it again, or skip it."),
    ] = "shoot"

    def check(self, file: str, timelapse: bool) -> None:
        """Raises DocumentError where these do not go with the file or with each other."""
        asked = [name for name in ("rehearse", "resume", "restart") if getattr(self, name)]
        in_doubt = ["in-doubt"] if self.in_doubt != NOTHING_ASKED.in_doubt else []
        by_hand = ["by-hand"] if self.by_hand else []
        if not timelapse and (unfit := asked + by_hand + in_doubt):
            raise DocumentError([f"--{unfit[0]}: {file} is not a timelapse"])
        if self.rehearse and self.by_hand:
            raise DocumentError(["--rehearse and --by-hand do not go together"])
        if len(asked) > 1:
            raise DocumentError([f"--{asked[0]} and --{asked[1]} do not go together"])


NOTHING_ASKED = ShootOptions()
