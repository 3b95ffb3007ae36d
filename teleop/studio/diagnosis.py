"""Why there is no Zenoh at an endpoint, found out by a connection without it: its own errors name no cause."""

from __future__ import annotations

import socket
import ssl
from typing import TYPE_CHECKING

from teleop.config.exchange.endpoint import endpoint

if TYPE_CHECKING:
    from teleop.studio.credentials import Credentials

CONNECTING = 0.5  # s
REFUSING = 0.3  # s in which the other side refuses a certificate, by TLS 1.3 after the handshake
SAME = "both sides need certificates that one `teleop fleet keys` folder has made"


def why_not(text: str, credentials: Credentials | None) -> str:
    """A sentence of what is wrong at this endpoint, and what to do; "" where nothing is found. Takes up to a second."""
    found = endpoint(text)
    try:
        with socket.create_connection((found.address.host, found.address.port), CONNECTING) as plain:
            if credentials is None:
                return "something else listens there, or it needs tls/ and --credentials"
            return _refused(plain, credentials)
    except ConnectionRefusedError:
        return "nothing listens there: is it started, and the port right?"
    except socket.gaierror:
        return f"there is no computer {found.address.host} on this network"
    except (TimeoutError, OSError):
        return "there is no answer: is the address right, and the network connected?"


def _refused(plain: socket.socket, credentials: Credentials) -> str:
    """Which of the two certificates the other side does not take."""
    try:
        with credentials.context().wrap_socket(plain) as protected:
            protected.settimeout(REFUSING)
            return "" if protected.recv(1) else "it closes the connection"
    except ssl.SSLCertVerificationError as error:
        return f"its certificate {_unverified(error.verify_message)}"
    except TimeoutError:
        return ""
    except ssl.SSLError as error:
        if "ALERT" in str(error.reason):
            return f"it does not take the certificate of {credentials.name}: {SAME}"
        return "it speaks no TLS: something else listens there"
    except OSError:
        return "it closes the connection"


def _unverified(why: str) -> str:
    if "purpose" in why:
        return "is an operator's: a rig and a router need their own"
    if "expired" in why or "not yet valid" in why:
        return f"is not valid now ({why}): are the clocks of both computers right?"
    return f"is of another fleet: {SAME}"
