"""`teleop play FILE`: a sequence on a rig."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from teleop.cli.drone_run import Understood, ask_to_fly, is_flown
from teleop.cli.key_terminal import key_terminal
from teleop.cli.operator_check import attended
from teleop.cli.options import DEFAULTS, MOVES, Options, is_take, warn
from teleop.cli.sequence_run import SequenceRun
from teleop.cli.shipped_files import named
from teleop.cli.shoot_options import NOTHING_ASKED, ShootOptions
from teleop.cli.staging_options import NO_STAGING, StagingOptions
from teleop.cli.trim_options import NO_TRIM, TrimOptions
from teleop.config.document import DocumentError
from teleop.config.profile import Profile
from teleop.core.axes import Axis
from teleop.core.clock import SystemClock, VirtualClock
from teleop.core.errors import UsageError
from teleop.core.events import Action
from teleop.inputs.keyboard import Keyboard
from teleop.inputs.playback_keymap import FLOWN_KEYS, KEYS, TRIM_KEYS, PlayKeys
from teleop.links import parse
from teleop.planner.keyframes.findings import PlanError
from teleop.planner.offset_limits import sequence_limits
from teleop.planner.time_scaling import NoRunUp
from teleop.sequence.source import SequenceSource
from teleop.sequence.trim_export import TrimmedFile

Fast = Annotated[
    bool,
    Parameter(help="Do not wait: simulated time, only on sim: links.", negative=(), show_default=False),
]
Take = Annotated[
    Path | None, Parameter(name="--take", metavar="FILE", help="Record everything the run does to a new .mcap file.")
]


def play(
    file: Annotated[
        str | None, Parameter(help="A shipped move's name, a sequence file, or a take (.mcap).", completer=MOVES)
    ] = None,
    /,
    *,
    speed: Annotated[
        str,
        Parameter(
            metavar="PERCENT", help="How fast, as a percentage: up to 200, as far as teleop check says the move allows."
        ),
    ] = "100%",
    staging: StagingOptions = NO_STAGING,
    shooting: ShootOptions = NOTHING_ASKED,
    trim: TrimOptions = NO_TRIM,
    fast: Fast = False,
    take: Take = None,
    i_understand: Understood = False,
    options: Options = DEFAULTS,
) -> int:
    """Play a sequence: ease to its first keyframe, then the move, then say how well the rig followed.

    A timelapse is shot, frame by frame; its journal in this folder knows where it was left.
    """
    left, file = trim.left, named("play", file, options.json)
    profile, performance, timelapse = options.compiled(file, left)
    shooting.check(file, timelapse is not None)
    axes = list(performance.move.tracks)
    shot = timelapse is not None and not shooting.rehearse
    profile = profile.in_use(axes, [*(cue.action for cue in performance.cues), *([Action.SHUTTER] if shot else [])])
    flown = is_flown(axes)
    if timelapse is not None and flown:
        raise DocumentError([f"{file}: a timelapse has no drone: it would fly on from frame to frame"])
    if timelapse is not None and not shooting.rehearse:
        from teleop.cli.shoot import shoot

        if staging != NO_STAGING or trim != NO_TRIM or speed != "100%":
            raise DocumentError([f"{file} is shot, not played: --speed and its kin go with --rehearse only"])
        return shoot(file, timelapse, profile, the_clock(fast, profile), shooting, take, options)
    if timelapse is not None:
        warn(performance)
    descriptor = None if fast else key_terminal()
    waits = descriptor is not None and not flown  # a drone does not stand still while a move waits
    performance = attended(file, performance, waits, fast)
    trimmed = None if trim.trim_out is None else _trimmed(file, trim.trim_out, axes, profile)
    if is_take(file):
        from teleop.recording.replay import followable

        profile = followable(profile)
    clock = the_clock(fast, profile)
    if trim.trim and fast:
        raise UsageError("--trim: a hand keeps its own time; leave out --fast")
    if flown:
        _refuse_to_fly(speed, staging, trim)
    ask_to_fly(performance.title, axes, i_understand)
    rate, stage = percentage("--speed", speed), staging.staging(performance, clock, waits)
    try:
        source = SequenceSource(performance, sequence_limits(profile.limits, left), rate, staging=stage)
    except NoRunUp as error:
        raise DocumentError([f"--start-at {staging.start_at}: {error}"]) from None
    except PlanError as error:
        raise DocumentError([f"--speed {speed}: {error}"]) from None
    keys = (
        None
        if descriptor is None
        else Keyboard(descriptor, PlayKeys(FLOWN_KEYS if flown else TRIM_KEYS if trim.trim else KEYS))
    )
    run = SequenceRun(profile, performance, source, clock, keys, left, trimmed, take, options.json, patient=fast)
    return run.perform()


def _refuse_to_fly(speed: str, staging: StagingOptions, trim: TrimOptions) -> None:
    """Raises DocumentError for what makes a move of a drone's sticks another one."""
    if percentage("--speed", speed) != 1:
        raise DocumentError([f"--speed {speed}: a drone's sticks held for longer or shorter fly it somewhere else"])
    if staging.start_at is not None:
        raise DocumentError([f"--start-at {staging.start_at}: a drone flies its moves from their beginning"])
    if trim.trim:
        raise DocumentError(["--trim: a drone's sticks are not moved aside; fly it by hand in teleop live"])


def _trimmed(file: str, target: Path, axes: Sequence[Axis], profile: Profile) -> TrimmedFile:
    if is_take(file):
        raise UsageError("--trim-out: a take has no keys to move")
    return TrimmedFile(file, target, axes, profile.limits)


def percentage(option: str, text: str) -> float:
    """`150%` or `150` as 1.5; raises DocumentError."""
    try:
        percent = float(text.strip().removesuffix("%"))
    except ValueError:
        percent = math.nan
    if not 0 < percent < math.inf:
        raise DocumentError([f"{option} {text}: must be a percentage above 0, as in 50%"])
    return percent / 100


def the_clock(fast: bool, profile: Profile) -> SystemClock | VirtualClock:
    """The machine's clock, or a virtual one where nothing real is at the end of a link; raises DocumentError."""
    if not fast:
        return SystemClock()
    real = [f"{name}={url}" for name, url in profile.links.items() if parse(url).kind != "sim"]
    if real:
        raise DocumentError([f"--fast: {', '.join(real)} keeps its own time; only sim: links can be played fast"])
    return VirtualClock()
