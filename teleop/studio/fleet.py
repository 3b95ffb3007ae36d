"""The rigs of a studio as one operator sees and commands them: `with Fleet([...]) as fleet`.

Each endpoint has a link; a rig may be reached by several, and is asked by the one that was heard last. Everything may
be called from any thread.
"""

from __future__ import annotations

import getpass
import secrets
import socket
import threading
import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Any, Self

from teleop.core.errors import TeleopError
from teleop.studio import clocks
from teleop.studio.link import Link
from teleop.studio.memory import memory_file, recalled, remember
from teleop.studio.rig_state import RigState, remembered
from teleop.studio.transport import require

if TYPE_CHECKING:
    from teleop.studio.credentials import Credentials

FIRST = 4.0  # s for the rigs that are there already
ANSWER = 3.0  # s for the answer to a command
CLOCK_ANSWER = 0.2  # s for the answer of a clock: a later one tells nothing
ROUNDS = 8  # of the clock at once
LOOK = 0.01  # s
ROLE = "the role `operate` in its access.yaml"


class Fleet:
    """`endpoints` are rigs and routers. `name` is what the holder of control is called; `memory` False keeps nothing.

    Raises UsageError without the package.
    """

    def __init__(
        self,
        endpoints: Iterable[str],
        credentials: Credentials | None = None,
        name: str = "",
        memory: bool = True,
    ) -> None:
        require()
        self.session, self.name = secrets.token_hex(8), name or operator_name()
        self._file: Path | None = memory_file() if memory else None
        self._rigs = {name: remembered(name, seen) for name, seen in recalled(self._file).items()}
        self._lock = threading.Lock()
        self._links = [Link(each, credentials, self) for each in dict.fromkeys(endpoints)]
        self._asked: set[str] = set()  # rigs that know this session

    def __enter__(self) -> Self:
        for link in self._links:
            link.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Leave every rig, and close every session."""
        for name in sorted(self._asked):
            self.ask(name, "command", {"do": "leave"}, 0.5)
        remember(self._file, {rig.name: rig.seen for rig in self.rigs if rig.token or rig.state})
        for link in self._links:
            link.close()

    # --- what is seen

    @property
    def rigs(self) -> list[RigState]:
        """All that are known, by name."""
        with self._lock:
            return [self._rigs[name] for name in sorted(self._rigs)]

    @property
    def problems(self) -> list[str]:
        """Why there is no rig at some endpoints."""
        return [link.problem for link in self._links if link.problem]

    @property
    def silent(self) -> list[str]:
        """Endpoints at which no rig was heard yet, or not all those that are there."""
        return [link.endpoint for link in self._links if not (link.heard and link.ready.is_set())]

    def rig(self, name: str) -> RigState:
        """Raises TeleopError for one that was never seen."""
        with self._lock:
            if (found := self._rigs.get(name)) is not None:
                return found
            known = ", ".join(sorted(self._rigs)) or ", ".join(["none", *self.problems[:1]])
        raise TeleopError(f"there is no rig {name}; seen: {known}")

    def wait(self, seconds: float = FIRST) -> None:
        """Until every endpoint was tried, and the newest state of each rig behind them is there."""
        end = monotonic() + seconds
        for link in self._links:
            link.tried.wait(max(0.0, end - monotonic()))
            if not link.problem:
                link.ready.wait(max(0.0, end - monotonic()))
        self.until(lambda: all(rig.state for rig in self.rigs if rig.token), min(1.0, end - monotonic()))

    def until(self, holds: Callable[[], object], seconds: float) -> bool:
        """Whether it holds within the time."""
        end = monotonic() + seconds
        while not holds():
            if monotonic() > end:
                return False
            time.sleep(LOOK)
        return True

    # --- what links hear

    def heard_state(self, link: Link, rig: str, state: dict[str, Any], arrived: float) -> None:
        with self._lock:
            entry = self._rigs.setdefault(rig, RigState(rig))
            entry.state, entry.arrived, entry.link = state, arrived, link
            entry.token = True  # its token may be on the way yet
            entry.seen = time.time()

    def heard_alive(self, link: Link, rig: str, alive: bool) -> None:
        with self._lock:
            entry = self._rigs.setdefault(rig, RigState(rig))
            if alive or entry.link in (link, None):
                entry.token = alive
                entry.gone = entry.gone if alive else monotonic()
            if alive:
                entry.link = entry.link or link

    # --- what is asked

    def ask(self, name: str, what: str, message: dict[str, Any], timeout: float = ANSWER) -> dict[str, Any]:
        """The answer of a rig: `{"ok": True, ...}`, or `error` with its `kind` and for "busy" the `holder`."""
        rig = self.rig(name)
        if (link := rig.link) is None:
            return {"error": f"{name} cannot be reached", "kind": "lost"}
        asked = monotonic()
        answer = link.ask(name, what, {**message, "session": self.session, "name": self.name}, timeout)
        if answer.get("kind") == "lost" and link.member and rig.alive and monotonic() - asked < timeout:
            return {**answer, "error": f"{name} does not answer {link.member}: that needs {ROLE}"}
        return answer

    def command(self, name: str, message: dict[str, Any], timeout: float = ANSWER) -> dict[str, Any]:
        """As `ask`, of any command of the door. From then on the rig knows whether this operator is there."""
        self.present(name)
        return self.ask(name, "command", message, timeout)

    def present(self, name: str) -> None:
        """Have the rig free control when this process, or the way to it, is gone."""
        if (link := self.rig(name).link) is not None:
            link.present(name, self.session)
            self._asked.add(name)

    def left(self, name: str) -> None:
        """Free control of the rig; what goes on there unattended goes on."""
        rig = self.rig(name)
        if name in self._asked:
            self.ask(name, "command", {"do": "leave"}, 1.0)
            self._asked.discard(name)
            if rig.link is not None:
                rig.link.absent(name)

    def measure_clock(self, name: str, rounds: int = ROUNDS) -> clocks.Offset | None:
        """How far the rig's clocks are from this machine's, by the best of some round trips and what was known."""
        rig = self.rig(name)
        for _ in range(rounds):
            sent = monotonic()
            answer = self.ask(name, "command/clock", {}, CLOCK_ANSWER)
            arrived = monotonic()
            if "error" in answer and not rig.alive:
                break
            if "error" not in answer:
                with suppress(ValueError, OverflowError):  # it tells no time: its clock stays unknown
                    rig.offset = clocks.better(rig.offset, clocks.measured(answer, sent, arrived))
        return rig.offset

    def measure_clocks(self, names: Sequence[str] | None = None) -> None:
        """Of all that are alive, side by side."""
        chosen = [rig.name for rig in self.rigs if rig.alive] if names is None else names
        side_by_side(chosen, self.measure_clock)


def side_by_side(names: Sequence[str], work: Callable[[str], object]) -> None:
    """`work` for each name, in a thread of its own, until all are done."""
    threads = [threading.Thread(target=work, args=(name,), daemon=True) for name in names]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def operator_name() -> str:
    """Who operates, as others see it: the user and the machine."""
    try:
        user = getpass.getuser()
    except (OSError, KeyError):
        user = "operator"
    return f"{user}@{socket.gethostname().partition('.')[0]}"[:40]
