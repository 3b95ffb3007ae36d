"""Who may do what: tokens to roles, and the cookie that a browser keeps instead of a token.

A cookie is signed with a key made of the tokens, and nothing is stored: it is good after a restart of the gateway, and
worthless once the tokens are others. All comparisons take the same time whatever is compared.
"""

from __future__ import annotations

import hashlib
import hmac
import secrets
import time
from collections.abc import Callable

from teleop.console.settings import ConsoleSettings, Role

COOKIE_SECONDS = 7 * 24 * 3600  # a week's shoot
MOST_COOKIE = 200  # characters
ROLES: tuple[Role, ...] = ("operate", "watch")


class Logins:
    """Checks tokens and cookies. `clock` gives seconds since 1970."""

    def __init__(self, settings: ConsoleSettings, clock: Callable[[], float] = time.time) -> None:
        self.is_open = settings.is_open
        self.cookie_name = f"teleop_{settings.port}"  # cookies know no ports: two consoles have two names
        self._is_secure = settings.has_tls
        self._clock = clock
        self._digests = {"operate": _digest(settings.token), "watch": _digest(settings.watch_token)}
        self._has = {"operate": bool(settings.token), "watch": bool(settings.watch_token)}
        self._key = hashlib.sha256(b"teleop console cookie" + b"".join(self._digests.values())).digest()

    def role_of_token(self, token: str) -> Role | None:
        """What the token allows; None for a wrong one. Both are compared, always."""
        given = _digest(token)
        equal = {role: hmac.compare_digest(given, digest) for role, digest in self._digests.items()}
        return next((role for role in ROLES if equal[role] and self._has[role]), None)

    def role_of_cookie(self, value: str) -> Role | None:
        """What the cookie allows; None for one that is forged, of other tokens or too old."""
        if len(value) > MOST_COOKIE:
            return None
        text, _, given = value.rpartition(".")
        if not hmac.compare_digest(self._mac(text).encode(), given.encode()):
            return None
        name, expires, _ = text.split(".")  # it is one of ours
        return None if float(expires) < self._clock() else next(role for role in ROLES if role == name)

    def cookie(self, role: Role) -> str:
        """The Set-Cookie header for a role."""
        text = f"{role}.{int(self._clock()) + COOKIE_SECONDS}.{secrets.token_hex(8)}"
        value = f"{self.cookie_name}={text}.{self._mac(text)}"
        secure = "; Secure" if self._is_secure else ""
        return f"{value}; Path=/; HttpOnly; SameSite=Strict; Max-Age={COOKIE_SECONDS}{secure}"

    def _mac(self, text: str) -> str:
        return hmac.new(self._key, text.encode("utf-8", "surrogateescape"), hashlib.sha256).hexdigest()


def _digest(token: str) -> bytes:
    return hashlib.sha256(token.encode("utf-8", "surrogateescape")).digest()
