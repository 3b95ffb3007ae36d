"""A commissioning that is started from the page of `teleop console`: between two runs of its rig."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path

from teleop.app.commission.kept import Kept, Wanted
from teleop.app.commission.session import Commissioning
from teleop.cli.commission_run import CommissionRun, counted, hands_of, opened
from teleop.cli.options import Options
from teleop.cli.screens.folded import tell
from teleop.config.profile import Profile
from teleop.console.settings import planned_for
from teleop.core.clock import SystemClock
from teleop.core.errors import TeleopError
from teleop.remote.gateway_child import Gateway


@dataclass(frozen=True)
class Commissioned:
    """What came of it: the `rig` to go on with, which is the profile that was written, and a line to say.

    `interrupted` is whether the whole program is to end.
    """

    options: Options
    line: str
    interrupted: bool = False


def commission_between(device: str, options: Options, output: Path | None, gateway: Gateway) -> Commissioned:
    """Commission a device; the rig's link is free. What keeps it from beginning is a line, and the console goes on."""
    profile, clock = options.profile(), SystemClock()
    kept = Kept(Wanted(), profile.name, device, clock.now)
    served = _serving(gateway, kept.folder.absolute())
    target = output if device == "gimbal" else None
    try:
        with kept:
            made = opened(profile, options.rig, device, target, options.link, clock, kept)
            run = CommissionRun(made, kept, clock, None, hands_of(made, device, served), gateway.greetings[0])
            run.run(lambda: 0)
    except TeleopError as error:
        return Commissioned(options, f"not commissioned: {error}")
    written = str(made.file.file) if isinstance(made, Commissioning) and made.written else ""
    results = f"; results: {kept.files[0]}" if kept.files else ""
    line = f"commissioned: {counted(made.findings)}{f'; the profile is {written}' if written else ''}{results}"
    if not options.json:
        tell(line)
    return Commissioned(replace(options, rig=written or options.rig), line, bool(run.interrupted))


def planning_for(gateway: Gateway, profile: Profile) -> Gateway:
    """The same console for another profile of the rig."""
    return _changed(gateway, rig=planned_for(profile))


def _serving(gateway: Gateway, results: Path) -> Gateway:
    """The page alone, on the same address: what else the profile serves is there again after it."""
    served = _changed(gateway, results=str(results))
    return served._replace(settings={"console": served.settings["console"]}, passed=served.passed[:1])


def _changed(gateway: Gateway, **changes: str) -> Gateway:
    console = gateway.settings["console"]
    settings = json.dumps({**json.loads(console["settings"]), **changes})
    return gateway._replace(settings={**gateway.settings, "console": {**console, "settings": settings}})
