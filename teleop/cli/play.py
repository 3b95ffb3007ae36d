"""`teleop play FILE`: a sequence on a rig."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from teleop.app.beside import BesideRun
from teleop.app.clocks import clock_for, real_links
from teleop.app.planning import Plan, is_take
from teleop.app.play import attended, devices_in_use, following, source_of
from teleop.app.realtime import realtime
from teleop.app.sequence_run import SequenceRun
from teleop.cli.console_options import NO_CONSOLE, Console, ConsoleOptions, Realtime
from teleop.cli.drone_run import Understood, ask_to_fly
from teleop.cli.key_terminal import key_terminal
from teleop.cli.learned_options import NOT_LEARNED, LearnedOptions, LearningReport
from teleop.cli.options import DEFAULTS, MOVES, Options, print_warnings
from teleop.cli.running import EXIT_CODES, Extra, print_report
from teleop.cli.screens.folded import after_the_run, complain, warn
from teleop.cli.screens.repeatability_table import PassesReport
from teleop.cli.screens.run_rows import NO_KEYS, RUN_HINTS
from teleop.cli.screens.run_view import RunView
from teleop.cli.screens.take_summary import take_words
from teleop.cli.shipped_files import named
from teleop.cli.shooting.options import NOTHING_ASKED, ShootOptions
from teleop.cli.signals import signals_to
from teleop.cli.staging_options import NO_STAGING, StagingOptions
from teleop.cli.trim_options import NO_TRIM, TrimOptions, TrimReport
from teleop.config.documents.document import DocumentError
from teleop.config.profile import Profile
from teleop.core.axes import Axis, Limits
from teleop.core.clock import SystemClock, VirtualClock
from teleop.core.errors import UsageError
from teleop.core.run_state import Result
from teleop.core.run_status import RunStatus
from teleop.inputs.keyboard import Keyboard
from teleop.inputs.playback_keymap import FLOWN_KEYS, KEYS, TRIM_KEYS, PlayKeys
from teleop.planner.keyframes.findings import PlanError
from teleop.planner.time_scaling import NoRunUp
from teleop.recording.writer import Recorder
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.cycle import Corrector, Cycle
from teleop.sequence.source import SequenceSource
from teleop.sequence.trim_export import TrimmedFile

if TYPE_CHECKING:
    from teleop.learning.pass_learner import PassLearner
    from teleop.remote.gateway_child import Gateway

Fast = Annotated[
    bool,
    Parameter(
        help="Run on simulated time, as fast as possible; only with sim: links.", negative=(), show_default=False
    ),
]
Take = Annotated[Path | None, Parameter(name="--take", metavar="FILE", help="Record the run to a new .mcap file.")]


def play(
    file: Annotated[
        str | None, Parameter(help="A shipped move's name, a sequence file, or a take (.mcap).", completer=MOVES)
    ] = None,
    /,
    *,
    speed: Annotated[
        str,
        Parameter(metavar="PERCENT", help="Playback speed, up to 200; teleop check shows the move's maximum."),
    ] = "100%",
    staging: StagingOptions = NO_STAGING,
    shooting: ShootOptions = NOTHING_ASKED,
    trim: TrimOptions = NO_TRIM,
    learning: LearnedOptions = NOT_LEARNED,
    fast: Fast = False,
    take: Take = None,
    console: Console = None,
    reached: ConsoleOptions = NO_CONSOLE,
    in_real_time: Realtime = False,
    i_understand: Understood = False,
    options: Options = DEFAULTS,
) -> int:
    """Play a sequence: ease to its first keyframe, then the move, then report how well the rig followed.

    A timelapse is shot, frame by frame; its journal in this folder has the frames that were shot.
    """
    file = named("play", file, options.json)
    plan = options.plan(file, trim.left, shooting.by_hand)
    shooting.check(file, plan.timelapse is not None)
    if plan.timelapse is not None and plan.is_flown:
        raise DocumentError([f"{file}: a timelapse cannot fly a drone: leave out the stick axes"])
    ordered = Ordered(speed, staging, trim, learning)
    if fast and console is not None:
        raise UsageError("--console: a browser is in real time; leave out --fast")
    if plan.timelapse is not None and shooting.rehearse:
        print_warnings(plan.sequence.warnings)
    replaced = "--fast" if fast else ""
    with reached.beside(console, options, plan.profile, replaced) as gateway, realtime(in_real_time, complain):
        beside = None if gateway is None else _hands(gateway)
        if plan.timelapse is not None and not shooting.rehearse:
            return _shoot(file, plan, ordered, shooting, fast, take, options, beside)
        return _play(file, plan, ordered, fast, take, i_understand, options, beside)


def _hands(gateway: Gateway) -> BesideRun:
    from teleop.remote.run_hands import RunHands

    return RunHands(gateway)


@dataclass(frozen=True)
class Ordered:
    """The options that change how a move is played."""

    speed: str
    staging: StagingOptions
    trim: TrimOptions
    learning: LearnedOptions


AS_WRITTEN = Ordered("100%", NO_STAGING, NO_TRIM, NOT_LEARNED)


def _shoot(
    file: str,
    plan: Plan,
    ordered: Ordered,
    shooting: ShootOptions,
    fast: bool,
    take: Path | None,
    options: Options,
    beside: BesideRun | None,
) -> int:
    from teleop.cli.shooting.shoot import shoot

    if ordered != AS_WRITTEN:
        raise DocumentError([f"{file} is a timelapse: --speed, --trim and the options of passes need --rehearse"])
    assert plan.timelapse is not None
    profile = devices_in_use(plan, shoots=True)
    return shoot(file, plan.timelapse, profile, the_clock(fast, profile), shooting, take, options, beside)


def _play(
    file: str,
    plan: Plan,
    ordered: Ordered,
    fast: bool,
    take: Path | None,
    understood: bool,
    options: Options,
    beside: BesideRun | None,
) -> int:
    staging, trim = ordered.staging, ordered.trim
    profile = devices_in_use(plan, shoots=False)
    descriptor = None if fast else key_terminal()
    has_keys = descriptor is not None and not plan.is_flown  # a drone does not stand still while a move waits
    sequence = attended(file, plan.sequence, has_keys, fast)
    if len(sequence.cues) < len(plan.sequence.cues):
        print("--fast: waits for the operator are skipped", file=sys.stderr)
    trimmed = None if trim.trim_out is None else _trimmed(file, trim.trim_out, plan.axes, profile)
    profile = following(profile) if is_take(file) else profile
    clock = the_clock(fast, profile)
    if trim.trim and fast:
        raise UsageError("--trim: an operator works in real time; leave out --fast")
    if plan.is_flown:
        _refuse_to_fly(ordered.speed, staging, trim)
    ask_to_fly(sequence.title, plan.axes, understood)
    ordered.learning.check(plan, percentage("--speed", ordered.speed), staging, trim.trim)
    cycle = staging.staging(sequence, clock, has_keys)
    lessons = _lessons(file, plan, profile, ordered.learning, Staged(cycle, take, fast, trim.left), options)
    cycle = cycle if lessons is None else lessons.staged(cycle)
    source = _source(sequence, profile, ordered, cycle)
    keymap = FLOWN_KEYS if plan.is_flown else TRIM_KEYS if trim.trim else KEYS
    keys = None if descriptor is None else Keyboard(descriptor, PlayKeys(keymap))
    with after_the_run() as notify:
        learns = lessons and lessons.learner
        run = SequenceRun(
            profile,
            sequence,
            source,
            clock,
            keys,
            notify,
            warn,
            trim.left,
            trimmed,
            take,
            fast,
            learns,
            beside,
        )
        return _performed(run, options, lessons)


@dataclass(frozen=True)
class Staged:
    """What surrounds the passes: `share` is what a trim leaves of the limits."""

    cycle: Cycle
    take: Path | None
    fast: bool
    share: float


@dataclass(frozen=True)
class Lessons:
    """What corrects the passes, and what learns from them and is kept in `file`."""

    corrector: Corrector
    learner: PassLearner | None
    file: Path

    def staged(self, cycle: Cycle) -> Cycle:
        from teleop.app.learning import corrected

        return corrected(cycle, self.corrector)


def _lessons(
    file: str, plan: Plan, profile: Profile, learning: LearnedOptions, staged: Staged, options: Options
) -> Lessons | None:
    """Nothing where neither --learn nor --learned is given. Raises UsageError and DocumentError."""
    if not learning.asked:
        return None
    from teleop.app.learning import Known, learner

    target = learning.file(file, staged.take) if learning.learn else Path()
    known = learning.known(plan, profile, staged.share, options.json)
    triggered = staged.cycle.trigger is not None
    if known is not None and triggered and (early := known.lead):
        print_warnings([f"{learning.learned}: the move's own zero is {early:g} s after the trigger"])
    if not learning.learn:
        assert known is not None
        return Lessons(Known(known.applied(plan.sequence.move)), None, target)
    learns = learner(profile, plan.sequence, target, known, staged.fast, triggered, lambda _line: None)
    return Lessons(learns, learns, target)


def _source(sequence: CompiledSequence, profile: Profile, ordered: Ordered, cycle: Cycle) -> SequenceSource:
    """Raises DocumentError for a speed or a start that the limits do not allow."""
    rate = percentage("--speed", ordered.speed)
    try:
        return source_of(sequence, profile, ordered.trim.left, rate, cycle)
    except NoRunUp as error:
        raise DocumentError([f"--start-at {ordered.staging.start_at}: {error}"]) from None
    except PlanError as error:
        raise DocumentError([f"--speed {ordered.speed}: {error}"]) from None


def _performed(run: SequenceRun, options: Options, lessons: Lessons | None) -> int:
    """Run it with a view, and print the report; the exit code."""

    def view(limits: Mapping[Axis, Limits], status: Callable[[float], RunStatus], recorder: Recorder | None) -> RunView:
        hints = NO_KEYS if run.keys is None else RUN_HINTS
        return RunView(run.sequence.title, limits, status, options.json, take_words(recorder), hints=hints)

    report = run.perform(view, signals_to)
    extras: list[Extra] = []
    if report.repeatability is not None:
        extras.append(PassesReport(report.repeatability))
    if lessons is not None and lessons.learner is not None:
        extras.append(LearningReport(lessons.learner, lessons.file))
    if report.trim is not None:
        extras.append(TrimReport(report.trim))
    code = print_report(report.run, options.json, extras)
    lost = report.trim is not None and report.trim.failure
    return code or (EXIT_CODES[Result.FAILED] if lost else code)


def _refuse_to_fly(speed: str, staging: StagingOptions, trim: TrimOptions) -> None:
    """Raises DocumentError for what makes a move of a drone's sticks another one."""
    if percentage("--speed", speed) != 1:
        raise DocumentError([f"--speed {speed}: a drone's move has one speed: leave out --speed"])
    if staging.start_at is not None:
        raise DocumentError(
            [f"--start-at {staging.start_at}: a drone's move starts at its first key: leave out --start-at"]
        )
    if trim.trim:
        raise DocumentError(["--trim: a drone's move cannot be trimmed: use teleop live"])


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
    """The machine's clock, or with --fast a virtual one; raises DocumentError where a real device is on a link."""
    if fast and (real := real_links(profile)):
        raise DocumentError([f"--fast: {', '.join(real)} runs in real time; only sim: links can be played fast"])
    return clock_for(fast)
