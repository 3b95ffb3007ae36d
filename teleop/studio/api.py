"""Several rigs for a program: `teleop.fleet([...])`."""

# pyright: strict

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Self

from teleop.config.exchange.endpoint import endpoint
from teleop.core.errors import TeleopError, UsageError
from teleop.studio.common_start import CommonStart, FleetError, SentMove, play
from teleop.studio.credentials import load
from teleop.studio.fleet import Fleet
from teleop.studio.stopping import PATIENCE, stop

ANSWER = 60.0  # s for an action that is waited for


class Rigs:
    """Several rigs, connected: use it in a `with` block, which leaves them.

    A rig is known from when it was first heard; one that is lost stays known, with `alive` False.
    """

    def __init__(self, endpoints: Sequence[str], credentials: str | Path | None = None, name: str = "") -> None:
        for text in endpoints:
            try:
                endpoint(text)
            except ValueError as error:
                raise UsageError(f"fleet: {text}: {error}") from None
        known = None if credentials is None else load(str(credentials))
        self._fleet = Fleet(endpoints, known, name, memory=False)

    def __enter__(self) -> Self:
        self._fleet.__enter__()
        self._fleet.wait()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Leave every rig. Moves that are not attended go on."""
        self._fleet.close()

    @property
    def names(self) -> tuple[str, ...]:
        """All rigs that were heard."""
        return tuple(rig.name for rig in self._fleet.rigs)

    def rigs(self) -> list[dict[str, Any]]:
        """Each rig as `teleop fleet --json` has it: name, alive, state, holder, move, error and more."""
        return [rig.as_json() for rig in self._fleet.rigs]

    def state(self, name: str) -> dict[str, Any]:
        """The newest whole state of a rig, as its HTTP interface has it; raises TeleopError for an unknown one."""
        return dict(self._fleet.rig(name).state)

    def wait_for(self, *names: str, seconds: float = 10.0) -> None:
        """Until these rigs are there. Raises TeleopError with those that are not after `seconds`."""

        def missing() -> list[str]:
            alive = {rig.name for rig in self._fleet.rigs if rig.alive}
            return [name for name in names if name not in alive]

        if not self._fleet.until(lambda: not missing(), seconds):
            raise TeleopError(f"not there: {', '.join([*missing(), *self._fleet.problems])}")

    def stop(self, *names: str, seconds: float = PATIENCE) -> list[str]:
        """STOP these rigs, or all; it is repeated until the state of each shows it. Returns those that do not show it.

        For all, that has the endpoints too at which no rig was heard. It is no emergency stop: the motors stay powered.
        """
        for name in names:
            self._fleet.rig(name)
        return stop(self._fleet, names or None, seconds)

    def command(self, name: str, do: str, *, wait: bool = False, **fields: Any) -> dict[str, Any]:
        """Any command of the HTTP interface on one rig, as in `command("cam-a", "goto", axes={"pan": 10})`.

        Control is taken for the action alone, unless `take_control` was asked for before. With `wait` it returns when
        the action has ended. Raises TeleopError with the rig's reason.
        """
        message = {"do": do, **fields, **({"wait": True} if wait else {})}
        if do not in ("take_control", "release_control", "deny_control", "stop", "clear"):
            message["brief"] = True
        answer = self._fleet.command(name, message, ANSWER)
        if "error" in answer:
            raise TeleopError(f"{name}: {answer['error']}")
        return answer

    def play(self, moves: Mapping[str, str | Path], *, after: float = 5.0, attended: bool = False) -> CommonStart:
        """Play a move (a file, or a shipped one's name) on each rig, `after` s from when all have accepted theirs.

        All begin at one moment of their clocks. Raises FleetError with each rig that cannot and why; then none plays.
        """
        sent = {name: SentMove.read(str(move)) for name, move in moves.items()}
        return play(self._fleet, sent, lambda: after, attended)


__all__ = ["CommonStart", "FleetError", "Rigs"]
