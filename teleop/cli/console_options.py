"""The options of the web console, for every command that has one beside its run, and what is printed of it."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from teleop.cli.key_terminal import key_terminal
from teleop.cli.options import Options
from teleop.cli.screens.folded import complain, tell
from teleop.cli.screens.invitation_sheet import announced
from teleop.config.profile import Profile
from teleop.console import DEFAULT_BIND
from teleop.core.errors import UsageError
from teleop.exchange.opening import opened

if TYPE_CHECKING:
    from teleop.console.settings import ConsoleSettings
    from teleop.remote.gateway_child import Gateway

_ADDRESS = re.compile(r"(\[[0-9a-fA-F:.]+\]|[^\s/\[\]:]*):\d+|\d+(\.\d+){3}")

Console = Annotated[
    str | None,
    Parameter(
        metavar="HOST:PORT", help=f"Also serve the console, at {DEFAULT_BIND} without an address.", show_default=False
    ),
]
Realtime = Annotated[
    bool,
    Parameter(
        name="--realtime",
        help="Run the control thread in real time (SCHED_FIFO) where that is permitted.",
        negative=(),
        show_default=False,
    ),
]


def with_console(arguments: Sequence[str]) -> list[str]:
    """What was typed, with the address of `--console`, or the default one, made one word with it."""
    result: list[str] = []
    for argument in arguments:
        if result and result[-1] == "--console":
            if _ADDRESS.fullmatch(argument):
                result[-1] += f"={argument}"
                continue
            result[-1] += f"={DEFAULT_BIND}"
        result.append(argument)
    if result and result[-1] == "--console":
        result[-1] += f"={DEFAULT_BIND}"
    return result


@Parameter(name="*")
@dataclass(frozen=True)
class ReachedOptions:
    """How the console is reached."""

    token: Annotated[
        str | None, Parameter(metavar="TOKEN", help="Token to log in with; without it one is made where it is needed.")
    ] = None
    watch_token: Annotated[
        str | None, Parameter(metavar="TOKEN", help="Token that only watches, and may press STOP; made where needed.")
    ] = None
    tls: Annotated[
        bool, Parameter(help="Serve HTTPS with a certificate made here.", negative=(), show_default=False)
    ] = False
    certificate: Annotated[
        Path | None, Parameter(metavar="FILE", help="Serve HTTPS with this certificate (PEM); --key has its key.")
    ] = None
    key: Annotated[
        Path | None, Parameter(metavar="FILE", help="The key of --certificate, if it is in another file.")
    ] = None

    @property
    def served(self) -> str:
        """The folder of the moves and takes that it shows, "" for none."""
        return ""

    @contextmanager
    def gateway(self, bind: str, options: Options, profile: Profile, results: str = "") -> Iterator[Gateway]:
        """What the gateway of the rig is started with, while it listens there; prints how to reach it.

        `results` is the folder that a commissioning leaves: while that goes on, nothing else is served.

        Raises UsageError and DeviceError for an address at which it cannot listen.
        """
        try:
            import starlette  # noqa: F401 - only whether it is there
            import uvicorn  # noqa: F401
        except ImportError:
            raise UsageError("the console needs its packages: pip install 'rs-teleop[console]'") from None
        from teleop.console.invitation import as_json as reached
        from teleop.console.invitation import greeting, invitation
        from teleop.console.settings import listen, with_tokens
        from teleop.gateway.announcing import ConsoleAt, announcement
        from teleop.remote.gateway_child import Gateway

        listener, settings = listen(with_tokens(self._asked(bind, profile, results)))
        invited = invitation(settings)
        if results:
            profile = profile.model_copy(update={"exchange": []})
        with listener, opened(profile) as exchange:
            if options.json:
                print(json.dumps(reached(settings)), flush=True)
            else:
                for line in (*invited.lines, *invited.code):
                    tell(line)
            number, where = listener.fileno(), listener.getsockname()
            console = {"settings": settings.as_json(), "listener": number}
            mdns = announcement(profile.name, ConsoleAt(where[0], where[1], settings.has_tls), profile.exchange)
            greetings = [greeting(settings), *([exchange.greeting] if exchange.greeting else [])]
            told = {"console": console, **mdns, **exchange.settings}
            yield Gateway(told, (number, *exchange.passed), greetings, invited)

    def _asked(self, bind: str, profile: Profile, results: str) -> ConsoleSettings:
        """What the console is to serve, and where. Raises UsageError and DeviceError."""
        from teleop.console.settings import ConsoleSettings, parse_bind, planned_for

        host, port = parse_bind(bind)
        folder = self.served or results
        tokens = self.token or "", self.watch_token or ""
        rig = planned_for(profile)
        zenoh = next((entry.model_dump(mode="json") for entry in profile.exchange if entry.type == "zenoh"), None)
        asked = ConsoleSettings(
            *(host, port, *tokens), moves=folder, takes=folder, results=results, rig=rig, fleet=zenoh
        )
        if self.tls or self.certificate or self.key:
            from teleop.console.certificate import with_tls

            return with_tls(asked, self.certificate, self.key)
        return asked

    @contextmanager
    def beside(
        self, bind: str | None, options: Options, profile: Profile, replaced: str = "", results: str = ""
    ) -> Iterator[Gateway | None]:
        """As `gateway`, where a console is asked for; without one, for the profile's exchange, and None without either.

        `replaced` is the option that has the run go without a hand or a clock, which leaves the exchange out. Raises
        UsageError for the options of a console that is not there.
        """
        if bind is not None:
            with self.gateway(bind, options, profile, results) as gateway:
                if key_terminal() is not None and not options.json:
                    gateway = gateway._replace(greetings=[announced(), *gateway.greetings[1:]])
                yield gateway
            return
        for name in ("token", "watch_token", "tls", "certificate", "key"):
            if getattr(self, name):
                raise UsageError(f"--{name.replace('_', '-')}: needs --console")
        if replaced and profile.exchange:
            complain(f"exchange: is not served with {replaced}")
        if replaced or not profile.exchange:
            yield None
            return
        from teleop.gateway.announcing import announcement
        from teleop.remote.gateway_child import Gateway

        with opened(profile) as exchange:
            settings = {**announcement(profile.name, None, profile.exchange), **exchange.settings}
            yield Gateway(settings, exchange.passed, [exchange.greeting])


@Parameter(name="*")
@dataclass(frozen=True)
class ConsoleOptions(ReachedOptions):
    """How the console is reached, and what it serves."""

    moves: Annotated[
        Path, Parameter(metavar="FOLDER", help="Folder of the moves and takes that the console shows.")
    ] = Path()

    @property
    def served(self) -> str:
        """Raises UsageError for what is no folder."""
        if not self.moves.is_dir():
            raise UsageError(f"--moves {self.moves}: is no folder")
        return str(self.moves.resolve())


NOT_REACHED, NO_CONSOLE = ReachedOptions(), ConsoleOptions()
