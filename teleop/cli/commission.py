"""`teleop commission`: asks a real gimbal, step by step, what it does, and writes the profile that is true of it."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from teleop.app.commission.profile_file import ProfileFile
from teleop.app.commission.session import TICK, Commissioning
from teleop.app.operator_inputs import device_backend
from teleop.cli.options import DEFAULTS, Options, announce
from teleop.cli.screens.commission_view import CommissionView
from teleop.cli.screens.folded import complain
from teleop.cli.signals import CODE, signals_to
from teleop.commission.findings import Findings, Verdict
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
    options: Options = DEFAULTS,
) -> int:
    """Commission a gimbal: find out, step by step and slowly, what it does, and write its profile.

    Each step says what will happen and how far. Enter goes, space stops; each step can be skipped, repeated or ended.
    """
    profile = options.profile()
    keyboard = _keyboard()
    urls = dict(text.split("=", 1) for text in options.link)
    file = ProfileFile(options.rig, output, urls)
    clock = SystemClock()
    interrupted: list[str] = []
    made = Commissioning(profile, file, clock, lambda: device_backend((), clock, lambda: float("inf")))
    view = CommissionView(profile.name, lambda: made.runner.page)
    with made, signals_to(interrupted.append, made.bench.release_at_once, view.notify), keyboard, view:
        _turn(made, keyboard, view, clock, interrupted)
    return _report(made, bool(interrupted), options.json)


def _turn(
    made: Commissioning, keyboard: Keyboard, view: CommissionView, clock: SystemClock, interrupted: list[str]
) -> None:
    """Until it is over."""
    runner, due = made.runner, clock.now()
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


def _report(made: Commissioning, interrupted: bool, as_json: bool) -> int:
    findings, written = made.findings, [made.file.file] if made.written else []
    if as_json:
        report = {"ok": made.written, "profile": str(made.file.file) if made.written else None}
        print(json.dumps({**report, "reason": made.runner.reason, "findings": json.loads(findings.to_json())}))
    elif made.written:
        announce(f"{made.file.file}: {counted(findings)}. Try it: teleop live --rig {made.file.file}", *written)
    if made.runner.reason and not as_json:
        complain(f"teleop: {made.runner.reason}")
    if not made.written and not as_json:
        complain("teleop: no profile was written")
    return CODE if interrupted else 0 if made.written else FAILED


def counted(findings: Findings) -> str:
    """How many facts have which verdict."""
    counts = {verdict: sum(fact.verdict is verdict for fact in findings.facts) for verdict in Verdict}
    return ", ".join(f"{count} {verdict}" for verdict, count in counts.items())
