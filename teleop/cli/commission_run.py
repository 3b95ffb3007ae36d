"""One commissioning, turned until it is over: by the keys of a terminal, by the pages of a browser, or by both."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack, nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from teleop.app.commission.drone_session import DroneCommissioning
from teleop.app.commission.kept import Kept
from teleop.app.commission.profile_file import ProfileFile
from teleop.app.commission.session import TICK, Commissioning
from teleop.app.operator_inputs import device_backend
from teleop.cli.screens.commission_view import CommissionView
from teleop.cli.screens.invitation_sheet import sheet
from teleop.cli.signals import signals_to
from teleop.commission.findings import Findings, Verdict
from teleop.commission.page import STOP
from teleop.config.profile import Profile
from teleop.core.clock import SystemClock
from teleop.core.errors import UsageError
from teleop.core.invitation import Invitation
from teleop.inputs.keyboard import Keyboard
from teleop.inputs.keymaps import INVITE
from teleop.inputs.named_keys import names

if TYPE_CHECKING:
    from teleop.remote.commission_hands import CommissionHands
    from teleop.remote.gateway_child import Gateway

Made = Commissioning | DroneCommissioning


def opened(
    profile: Profile, rig: str, device: str, output: Path | None, links: tuple[str, ...], clock: SystemClock, kept: Kept
) -> Made:
    """The commissioning of one device of a rig; `links` are those given instead of the profile's, NAME=URL."""
    if device == "drone":
        if output is not None:
            raise UsageError("-o: the commissioning of a drone writes no profile")
        return DroneCommissioning(profile, clock, tapped=kept.tapped)
    file = ProfileFile(rig, output, dict(text.split("=", 1) for text in links))
    backend = lambda: device_backend((), clock, lambda: float("inf"))  # noqa: E731 - opened when the pad is asked for
    return Commissioning(profile, file, clock, backend, tapped=kept.tapped)


def hands_of(made: Made, device: str, gateway: Gateway) -> CommissionHands:
    """The door of a commissioning, for what the gateway serves."""
    from teleop.remote.commission_hands import CommissionHands

    return CommissionHands(made.runner, made.profile.name, device, lambda: made.bench.connection, gateway)


def counted(findings: Findings) -> str:
    """How many facts have which verdict."""
    counts = {verdict: sum(fact.verdict is verdict for fact in findings.facts) for verdict in Verdict}
    return ", ".join(f"{count} {verdict}" for verdict, count in counts.items())


@dataclass
class CommissionRun:
    """`keyboard` is None without a terminal, `hands` without a browser; `greeting` says how that gets here.

    `invitation` is shown while a key asks for it. `interrupted` is why it was ended from outside, if it was.
    """

    made: Made
    kept: Kept
    clock: SystemClock
    keyboard: Keyboard | None
    hands: CommissionHands | None
    greeting: str = ""
    invitation: Invitation | None = None
    interrupted: list[str] = field(default_factory=list)
    inviting: bool = False

    def run(self, report: Callable[[], int]) -> int:
        """To its end, and on for as long as a browser shows that; what `report`, which prints it, returns."""
        made, hands = self.made, self.hands
        view = CommissionView(made.profile.name, lambda: made.runner.page, self._beside, sheet(self.invitation, self))
        with ExitStack() as stack:
            if hands is not None:
                hands.open(stack, self.clock)
            stack.enter_context(signals_to(self.interrupted.append, made.bench.release_at_once, view.notify))
            stack.enter_context(nullcontext() if self.keyboard is None else self.keyboard)
            with made, view:
                self._turn(view)
            self.kept.write(made.findings)
            code = report()
            if hands is not None and not self.interrupted and (self.keyboard is None or hands.pressed_last):
                self._linger(hands)
        return code

    def _turn(self, view: CommissionView) -> None:
        runner, clock, hands = self.made.runner, self.clock, self.hands
        due = clock.now()
        while not runner.over:
            now = clock.now()
            keys = self._pressed(now)
            if self.interrupted and not runner.reason:
                runner.interrupt(self.interrupted[0])
            runner.turn(now, keys if hands is None else hands.keys(now, keys))
            if hands is not None:
                hands.show(now)
            view.update()
            due = max(due + TICK, now)
            clock.sleep_until(due)

    def _pressed(self, now: float) -> list[str]:
        if self.keyboard is None:
            return []
        held = self.keyboard.read(now)
        if held.trouble:
            self.interrupted.append(held.trouble)
        return [key for key in names(list(held.presses)) if not self._invites(key)]

    def _invites(self, key: str) -> bool:
        """Whether a key was for the address, or comes while that covers the page: then only STOP counts."""
        page = self.made.runner.page
        if self.inviting:
            self.inviting = key != INVITE
            return key != STOP
        taken = self.invitation is None or page.typed is not None or INVITE in page.keys
        self.inviting = key == INVITE and not taken
        return self.inviting

    def _linger(self, hands: CommissionHands) -> None:
        """The last page stays until it is closed there, a key is pressed here, or nobody has looked at it for long."""
        clock, due = self.clock, self.clock.now()
        self.invitation, self.inviting = None, False
        hands.finish(due, [file.name for file in self.kept.files], self._outcome())
        while not (self.interrupted or hands.is_closed(clock.now())):
            if self._pressed(clock.now()):
                return
            hands.keys(clock.now(), ())
            hands.show(clock.now())
            due += TICK
            clock.sleep_until(due)

    def _outcome(self) -> list[str]:
        made = self.made
        lines = [f"{counted(made.findings)}."]
        if isinstance(made, Commissioning):
            lines.append(f"The profile is {made.file.file}." if made.written else "No profile was written.")
        return lines

    def _beside(self) -> str:
        """How the page is reached, and who has control."""
        if self.hands is None:
            return ""
        who = self.hands.desk.control.name
        return f"{self.greeting}   {who} has control" if who else self.greeting
