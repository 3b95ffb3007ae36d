"""`teleop commission`: asks a real gimbal, step by step, what it does, and writes the profile that is true of it."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from teleop.app.commission.drone_session import DroneCommissioning
from teleop.app.commission.profile_file import ProfileFile
from teleop.app.commission.session import TICK, Commissioning
from teleop.app.operator_inputs import device_backend
from teleop.cli.commission_results import NO_RESULTS, Kept, ResultOptions, compare_two, compares_two
from teleop.cli.options import DEFAULTS, Options, announce
from teleop.cli.screens.commission_view import CommissionView
from teleop.cli.screens.folded import complain, tell
from teleop.cli.signals import CODE, signals_to
from teleop.commission.findings import Findings, Verdict
from teleop.commission.runner import Runner
from teleop.config.profile import Profile
from teleop.core.clock import SystemClock
from teleop.core.errors import UsageError
from teleop.inputs.keyboard import Keyboard, has_keys, terminal
from teleop.inputs.named_keys import NamedKeys, names

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
    options: Options = DEFAULTS,
) -> int:
    """Commission a gimbal: find out, step by step and slowly, what it does, and write its profile. Or a drone.

    Each step says what will happen and how far. Enter goes, space stops; each step can be skipped, repeated or ended.
    A drone is commissioned with its propellers off; it writes no profile.
    """
    if compares_two(results):
        return compare_two(results.compare, options.json)
    profile = options.profile()
    keyboard = _keyboard()
    clock = SystemClock()
    device = device or ("drone" if profile.drones else "gimbal")
    kept = Kept(results, profile.name, device, clock.now)
    interrupted: list[str] = []
    with kept:
        made = _opened(profile, device, output, options, clock, kept)
        runner = made.runner
        view = CommissionView(profile.name, lambda: runner.page)
        with made, signals_to(interrupted.append, made.bench.release_at_once, view.notify), keyboard, view:
            _turn(runner, keyboard, view, clock, interrupted)
        kept.write(made.findings)
    return _report(made, kept, bool(interrupted), options.json)


def _opened(
    profile: Profile, device: str, output: Path | None, options: Options, clock: SystemClock, kept: Kept
) -> Commissioning | DroneCommissioning:
    if device == "drone":
        if output is not None:
            raise UsageError("-o: the commissioning of a drone writes no profile")
        return DroneCommissioning(profile, clock, tapped=kept.tapped)
    urls = dict(text.split("=", 1) for text in options.link)
    file = ProfileFile(options.rig, output, urls)
    backend = lambda: device_backend((), clock, lambda: float("inf"))  # noqa: E731 - opened when the pad is asked for
    return Commissioning(profile, file, clock, backend, tapped=kept.tapped)


def _turn(runner: Runner, keyboard: Keyboard, view: CommissionView, clock: SystemClock, interrupted: list[str]) -> None:
    """Until it is over."""
    due = clock.now()
    while not runner.over:
        now = clock.now()
        held = keyboard.read(now)
        if held.trouble:
            interrupted.append(held.trouble)
        if interrupted and not runner.reason:
            runner.interrupt(interrupted[0])
        runner.turn(now, names(list(held.presses)))
        view.update()
        due = max(due + TICK, now)
        clock.sleep_until(due)


def _keyboard() -> Keyboard:
    """Raises UsageError without a terminal whose keys may be read."""
    if sys.stdin is None or not sys.stdin.isatty():
        raise UsageError("teleop commission asks before anything moves: run it on a terminal")
    if not has_keys():
        raise UsageError("teleop commission cannot see single keys on this system: use Linux or macOS")
    descriptor = terminal()
    if descriptor is None:
        raise UsageError("teleop commission asks before anything moves: run it in the foreground")
    return Keyboard(descriptor, NamedKeys())


def _report(made: Commissioning | DroneCommissioning, kept: Kept, interrupted: bool, as_json: bool) -> int:
    findings, profile = made.findings, _profile_written(made)
    reason = made.runner.reason
    if not reason and all(fact.found is None for fact in findings.facts):
        reason = "nothing was found: every step was skipped, or had no point"
    is_done = profile is not None if isinstance(made, Commissioning) else not reason
    if as_json:
        report = {"ok": is_done, "profile": profile, **kept.facts(findings)}
        print(json.dumps({**report, "reason": reason, "findings": json.loads(findings.to_json())}))
        return CODE if interrupted else 0 if is_done else FAILED
    if profile is not None:
        announce(f"{profile}: {counted(findings)}. Try it: teleop live --rig {profile}", Path(profile))
    elif isinstance(made, DroneCommissioning) and is_done:
        tell(f"{counted(findings)}. The gimbal of this rig: teleop commission --device gimbal")
    kept.tell(findings)
    if reason:
        complain(f"teleop: {reason}")
    if isinstance(made, Commissioning) and profile is None:
        complain("teleop: no profile was written")
    return CODE if interrupted else 0 if is_done else FAILED


def _profile_written(made: Commissioning | DroneCommissioning) -> str | None:
    return str(made.file.file) if isinstance(made, Commissioning) and made.written else None


def counted(findings: Findings) -> str:
    """How many facts have which verdict."""
    counts = {verdict: sum(fact.verdict is verdict for fact in findings.facts) for verdict in Verdict}
    return ", ".join(f"{count} {verdict}" for verdict, count in counts.items())
