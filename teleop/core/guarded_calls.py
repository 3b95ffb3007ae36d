"""Calls out of the loop: whatever is raised in one becomes a fault with a reason, so that the run ends smoothly."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any

from teleop.core.errors import Interrupted, LeaveAtOnce, TeleopError
from teleop.core.run_state import RunEvent, RunStateMachine

FAULTS = 8  # that are kept: one repeats every tick

log = logging.getLogger(__name__)


class GuardedCalls:
    """`run` gets every fault, `interrupt` a Ctrl-C without a handler. `faults` has the first few, oldest first."""

    def __init__(self, run: RunStateMachine, interrupt: Callable[[str], object]) -> None:
        self.faults: list[BaseException] = []
        self._run, self._interrupt = run, interrupt

    def guarded(self, call: Callable[..., Any], *arguments: Any, default: Any = None) -> Any:
        """What `call` returns, or `default` where it raises: the other devices are still served, and the run stops.

        SystemExit too: a stage that exits may not take the run with it. LeaveAtOnce goes through.
        """
        try:
            return call(*arguments)
        except KeyboardInterrupt:
            self._interrupt("Ctrl-C")
        except LeaveAtOnce:
            raise
        except BaseException as fault:  # noqa: BLE001 - the one place where any exception is turned into a smooth stop
            self.fault(fault)
        return default

    def quietly(self, call: Callable[..., Any], *arguments: Any, default: Any = None) -> Any:
        """As `guarded`, for leaving at once: what fails then changes nothing any more."""
        try:
            return call(*arguments)
        except LeaveAtOnce:
            raise
        except BaseException as fault:
            log.debug("fault while leaving at once", exc_info=fault)
        return default

    def fault(self, fault: BaseException) -> None:
        """Note why the run has to end."""
        try:
            reason = str(fault) if isinstance(fault, TeleopError) else f"{type(fault).__name__}: {fault}"
        except LeaveAtOnce:
            raise
        except BaseException:  # noqa: BLE001 - an error without a text still ends the run
            reason = type(fault).__name__
        log.debug("fault: %s", reason, exc_info=fault)
        if len(self.faults) < FAULTS:
            self.faults.append(fault)
        self._run.handle(RunEvent.INTERRUPT if isinstance(fault, Interrupted) else RunEvent.FAULT, reason)
