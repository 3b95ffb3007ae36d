"""What the simulators refuse, as lines for a client's author: each kind at once, then how often, at the end all."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable
from typing import Any, Protocol

from teleop.sim.refusals import Refusal, Refusals, Why

AGAIN = 10.0  # s between two lines of the same kind

Kind = tuple[str, str, Why]  # device, command, reason


class Refusing(Protocol):
    """A simulated device: `counts` has the messages that came, by name."""

    @property
    def counts(self) -> Counter[str]: ...

    @property
    def refusals(self) -> Refusals: ...


class RefusalLines:
    """`write` gets whole lines: text, or with `as_json` an object each."""

    def __init__(self, write: Callable[[str], object], as_json: bool) -> None:
        self._write, self._as_json = write, as_json
        self._shown: Counter[Kind] = Counter()
        self._last: dict[Kind, float] = {}

    def look(self, name: str, device: Refusing, now: float) -> None:
        """Write what `device` has refused of late, as far as it is to be written now (s)."""
        latest = {(name, refusal.command, refusal.why): refusal for refusal in device.refusals.take()}
        for kind, refusal in latest.items():
            if kind not in self._last:
                self._show(kind, refusal, device, now)
        for kind, time in self._last.items():
            if kind[0] == name and now - time >= AGAIN and device.refusals.counts[kind[1:]] > self._shown[kind]:
                self._show(kind, latest.get(kind), device, now)

    def summary(self, name: str, device: Refusing) -> None:
        """Write how many messages came and how many were refused for which reason."""
        messages = sum(count for message, count in device.counts.items() if message != "refused")
        refused = device.refusals.counts
        if self._as_json:
            kinds = [{"command": command, "reason": why.value, "count": n} for (command, why), n in refused.items()]
            self._object(device=name, messages=messages, refused=refused.total(), kinds=kinds)
            return
        self._write(f"{name}: {messages} messages, {refused.total() or 'none'} refused")
        for (command, why), count in refused.most_common():
            self._write(f"  {command}: {why.value}, {count} x")

    def _show(self, kind: Kind, refusal: Refusal | None, device: Refusing, now: float) -> None:
        name, command, why = kind
        self._last[kind] = now
        more = device.refusals.counts[command, why] - self._shown[kind]
        first = not self._shown[kind]
        self._shown[kind] += more
        detail = refusal.detail if refusal else ""
        if self._as_json:
            self._object(device=name, refused=command, reason=why.value, detail=detail, count=self._shown[kind])
            return
        often = "" if first and more == 1 else f" ({more} times)" if first else f" ({more} times more)"
        self._write(f"{name} refused {command}: {why.value}{f': {detail}' if detail else ''}{often}")

    def _object(self, **fields: Any) -> None:
        self._write(json.dumps(fields))
