"""Whether a request is meant for this console: its Host, and where the page that made it came from.

A browser sends what any page asks for to any address. Host refuses names that an attacker's DNS points here; Origin and
Sec-Fetch-Site refuse other sites' pages. Both hold on loopback too, where every page on this computer's browser
reaches. A script sends neither of the last two, and is no browser.
"""

from __future__ import annotations

import socket
from collections.abc import Mapping

from teleop.config.exchange.address import is_loopback
from teleop.console.settings import ConsoleSettings

DEFAULT_PORTS = {"http": 80, "https": 443}


class OriginRules:
    """Hosts and origins that are this console's own."""

    def __init__(self, settings: ConsoleSettings) -> None:
        self._settings = settings
        self._scheme = "https" if settings.has_tls else "http"
        name = socket.gethostname().lower()
        self._names = {settings.host.lower(), name, f"{name.partition('.')[0]}.local"}

    def refusal(self, headers: Mapping[str, str], local: str, is_page: bool) -> str:
        """Why a request is refused, "" where it is not.

        `local` is this computer's address in the connection; `is_page`: it asks for a page and not for data.
        """
        host = headers.get("host", "").lower()
        if host not in self._hosts(local):
            return "the Host header is not this console's address"
        origin = headers.get("origin")
        if origin is not None and origin.lower() != f"{self._scheme}://{host}":
            return "the Origin header is another site's"
        site = headers.get("sec-fetch-site", "none")
        is_followed = (
            is_page and headers.get("sec-fetch-mode") == "navigate" and headers.get("sec-fetch-dest") == "document"
        )
        if site not in ("none", "same-origin") and not is_followed:
            return "another site's page asks for this"
        return ""

    def _hosts(self, local: str) -> set[str]:
        port = self._settings.port
        names = {*self._names, local}
        if is_loopback(local):
            names |= {"localhost", "127.0.0.1", "::1"}
        written = {f"[{name}]" if ":" in name else name for name in names if name}
        bare = written if port == DEFAULT_PORTS[self._scheme] else set()
        return {f"{name}:{port}" for name in written} | bare
