"""How somebody gets to the console: its URL with the token, as text and as a QR code for a phone.

The token is behind the `#`, which a browser keeps to itself: it is in no request, log or Referer. The login page takes
it from there.
"""

from __future__ import annotations

import hashlib
import ipaddress
import socket
import ssl
from collections.abc import Sequence
from pathlib import Path

from teleop.config.exchange.address import Address
from teleop.console.settings import ConsoleSettings, Role, is_loopback
from teleop.core.invitation import Invitation

QUIET = 2  # modules around a QR code: enough for every phone on a dark terminal, and 80x24 has room for it
_HALVES = {(True, True): "█", (True, False): "▀", (False, True): "▄", (False, False): " "}


def origin(settings: ConsoleSettings) -> str:
    """The address of the page without a path: `http://192.168.1.7:8470`."""
    scheme = "https" if settings.has_tls else "http"
    return f"{scheme}://{Address(reachable_host(settings.host), settings.port)}"


def url(settings: ConsoleSettings, role: Role = "operate") -> str:
    """What to open in a browser; it logs in by itself."""
    token = settings.token if role == "operate" else settings.watch_token
    return f"{origin(settings)}/login#{token}" if token else f"{origin(settings)}/"


def as_json(settings: ConsoleSettings) -> dict[str, str | None]:
    """The first line of `--json`."""
    return {
        "url": url(settings),
        "token": settings.token or None,
        "watch_url": url(settings, "watch"),
        "watch_token": settings.watch_token or None,
    }


def greeting(settings: ConsoleSettings) -> str:
    """How it is reached, in one line."""
    return f"Console: {url(settings)}"


def invitation(settings: ConsoleSettings) -> Invitation:
    """Lines for a terminal: the URL; with a token also both roles' tokens, and a QR code where a phone can reach it."""
    lines = [greeting(settings)]
    if settings.is_open:
        return Invitation([*lines, "Only this computer can open it. For a phone: give the address 0.0.0.0:8470"])
    lines += [f"Token to operate: {settings.token}", f"Token to watch, with STOP: {settings.watch_token}"]
    if settings.has_tls:
        lines.append(f"Certificate, SHA-256: {fingerprint(settings.certificate)[:47]}... (a browser warns of it once)")
    else:
        lines.append("Without --tls the network can read the tokens, and a phone may sleep.")
    return Invitation(lines, () if is_loopback(settings.host) else qr_lines(url(settings)))


def qr_lines(text: str) -> Sequence[str]:
    """A QR code for a dark terminal, two rows in each line. Raises ImportError without segno."""
    import segno

    rows = [[bool(dark) for dark in row] for row in segno.make(text, error="l", micro=False).matrix]
    width = len(rows[0]) + 2 * QUIET
    around = [[False] * width] * QUIET
    framed = [*around, *([False] * QUIET + row + [False] * QUIET for row in rows), *around]
    if len(framed) % 2:
        framed.append([True] * width)  # below the frame: as dark as the terminal
    return [_line(upper, lower) for upper, lower in zip(framed[::2], framed[1::2], strict=True)]


def _line(upper: Sequence[bool], lower: Sequence[bool]) -> str:
    """Two rows of modules: light ones are drawn, because a terminal is dark."""
    return "".join(_HALVES[not above, not below] for above, below in zip(upper, lower, strict=True))


def fingerprint(certificate: str) -> str:
    """SHA-256 of a certificate, as a browser shows it."""
    text = Path(certificate).read_text(encoding="ascii")
    begin, end = text.index(ssl.PEM_HEADER), text.index(ssl.PEM_FOOTER) + len(ssl.PEM_FOOTER)
    digest = hashlib.sha256(ssl.PEM_cert_to_DER_cert(text[begin:end])).hexdigest().upper()
    return ":".join(digest[i : i + 2] for i in range(0, len(digest), 2))


def reachable_host(host: str) -> str:
    """`host`, or for one that means every interface the address that others on the network use."""
    try:
        address = ipaddress.ip_address(host)
    except ValueError:
        return host
    if not address.is_unspecified:
        return host
    family, far = (socket.AF_INET6, "2001:db8::1") if address.version == 6 else (socket.AF_INET, "192.0.2.1")
    with socket.socket(family, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect((far, 9))  # sends nothing: asks the routing table only
        except OSError:
            return "::1" if address.version == 6 else "127.0.0.1"
        return str(probe.getsockname()[0])
