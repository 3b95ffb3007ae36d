"""`teleop commission`: asks a real gimbal, step by step, what it does, and writes the profile that is true of it."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from teleop.app.commission.drone_session import DroneCommissioning
from teleop.app.commission.kept import Kept
from teleop.app.commission.session import Commissioning
from teleop.cli.commission_results import NO_RESULTS, ResultOptions, compare_two, compares_two, tell_results
from teleop.cli.commission_run import CommissionRun, Made, counted, hands_of, opened
from teleop.cli.console_options import NOT_REACHED, Console, ReachedOptions
from teleop.cli.options import DEFAULTS, Options, announce
from teleop.cli.screens.folded import complain, tell
from teleop.cli.signals import CODE
from teleop.core.clock import SystemClock
from teleop.core.errors import UsageError
from teleop.inputs.keyboard import Keyboard, has_keys, terminal
from teleop.inputs.named_keys import NamedKeys

FAILED = 1


def commission(
    *,
    output: Annotated[
        Path | None,
        Parameter(name=("--output", "-o"), metavar="FILE", help="The profile to write, instead of the rig's own file."),
    ] = None,
    device: Annotated[
        Literal["gimbal", "drone"] | None,
        Parameter(help="Which device of the rig; without it, the drone of a rig that has one.", show_default=False),
    ] = None,
    results: ResultOptions = NO_RESULTS,
    console: Console = None,
    reached: ReachedOptions = NOT_REACHED,
    options: Options = DEFAULTS,
) -> int:
    """Commission a gimbal: find out, step by step and slowly, what it does, and write its profile. Or a drone.

    Each step says what will happen and how far. Enter goes, space stops; each step can be skipped, repeated or ended.
    A drone is commissioned with its propellers off; it writes no profile. With --console a browser shows the steps too.
    """
    if compares_two(results):
        return compare_two(results.compare, options.json)
    profile = options.profile()
    keyboard = _keyboard(console)
    clock = SystemClock()
    device = device or ("drone" if profile.drones else "gimbal")
    kept = Kept(results.wanted, profile.name, device, clock.now)
    with ExitStack() as stack:
        folder = str(kept.folder.absolute())
        gateway = stack.enter_context(reached.beside(console, options, profile, "a commissioning", folder))
        stack.enter_context(kept)
        made = opened(profile, options.rig, device, output, options.link, clock, kept)
        hands = None if gateway is None else hands_of(made, device, gateway)
        reached_by = ("", None) if gateway is None else (gateway.greetings[0], gateway.invitation)
        run = CommissionRun(made, kept, clock, keyboard, hands, *reached_by)
        return run.run(lambda: _report(made, kept, bool(run.interrupted), results.compare, options.json))


def _keyboard(console: str | None) -> Keyboard | None:
    """Raises UsageError without a terminal whose keys may be read, unless a browser has keys."""
    if sys.stdin is None or not sys.stdin.isatty():
        why = "teleop commission asks before anything moves: run it on a terminal, or with --console"
    elif not has_keys():
        why = "teleop commission cannot see single keys on this system: give --console"
    elif (descriptor := terminal()) is None:
        why = "teleop commission asks before anything moves: run it in the foreground, or with --console"
    else:
        return Keyboard(descriptor, NamedKeys())
    if console is None:
        raise UsageError(why)
    return None


def _report(made: Made, kept: Kept, interrupted: bool, compared_with: Sequence[Path], as_json: bool) -> int:
    findings, profile = made.findings, _profile_written(made)
    reason = made.runner.reason
    if not reason and all(fact.found is None for fact in findings.facts):
        reason = "nothing was found: every step was skipped, or had no point"
    is_done = profile is not None if isinstance(made, Commissioning) else not reason
    if as_json:
        report = {"ok": is_done, "profile": profile, **kept.facts(findings)}
        print(json.dumps({**report, "reason": reason, "findings": json.loads(findings.to_json())}), flush=True)
        return CODE if interrupted else 0 if is_done else FAILED
    if profile is not None:
        announce(f"{profile}: {counted(findings)}. Try it: teleop live --rig {profile}", Path(profile))
    elif isinstance(made, DroneCommissioning) and is_done:
        tell(f"{counted(findings)}. The gimbal of this rig: teleop commission --device gimbal")
    tell_results(kept, findings, compared_with)
    if reason:
        complain(f"teleop: {reason}")
    if isinstance(made, Commissioning) and profile is None:
        complain("teleop: no profile was written")
    return CODE if interrupted else 0 if is_done else FAILED


def _profile_written(made: Made) -> str | None:
    return str(made.file.file) if isinstance(made, Commissioning) and made.written else None
