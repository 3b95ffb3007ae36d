"""The options that every command of `teleop fleet` has: which rigs, and who asks."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from teleop.core.errors import UsageError

if TYPE_CHECKING:
    from teleop.studio.fleet import Fleet


@Parameter(name="*")
@dataclass(frozen=True)
class FleetOptions:
    """How the rigs are reached."""

    connect: Annotated[
        tuple[str, ...],
        Parameter(
            name="--connect",
            metavar="ENDPOINT",
            help="A rig or a router, as in tls/192.168.1.20:7447; may be repeated. Without it: rigs found by mDNS.",
            negative=(),
            show_default=False,
            consume_multiple=False,
        ),
    ] = ()
    credentials: Annotated[
        Path | None,
        Parameter(metavar="FILE", help="Credentials of this operator, made by `teleop fleet keys`.", negative=()),
    ] = None
    json: Annotated[bool, Parameter(help="Print JSON, for programs.", negative=(), show_default=False)] = False
    debug: Annotated[bool, Parameter(help="Print tracebacks.", negative=(), show_default=False)] = False

    @contextmanager
    def fleet(self, wait: bool = True) -> Iterator[Fleet]:
        """The rigs; with `wait`, as soon as those that are there are known. Raises UsageError and DocumentError."""
        from teleop.studio.credentials import load
        from teleop.studio.fleet import Fleet

        endpoints = self._endpoints()
        credentials = None if self.credentials is None else load(str(self.credentials))
        with Fleet(endpoints, credentials) as fleet:
            if wait:
                fleet.wait()
            yield fleet

    def _endpoints(self) -> list[str]:
        from teleop.config.exchange.endpoint import endpoint

        for text in self.connect:
            try:
                found = endpoint(text)
            except ValueError as error:
                raise UsageError(f"--connect {text}: {error}") from None
            if found.protocol == "tls" and self.credentials is None:
                raise UsageError(f"--connect {text}: needs --credentials, made by `teleop fleet keys`")
            if found.protocol == "tcp" and self.credentials is not None:
                raise UsageError(f"--connect {text}: with --credentials it must be tls/{text[4:]}")
        if self.connect:
            return list(self.connect)
        from teleop.cli.fleet.discovered import discovered

        return discovered(tls=self.credentials is not None)


DEFAULTS = FleetOptions()
