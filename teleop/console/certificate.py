"""TLS for the console: a certificate made here once and kept, or one that is given.

A phone has to be told once that it may trust a certificate that nobody has signed. So it is kept, and made anew only
when the computer has another address or the time is over.
"""

from __future__ import annotations

import ipaddress
import os
import socket
import ssl
from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING

from teleop.config.files import OutputError, write_text
from teleop.config.folders import state_folder
from teleop.console.invitation import reachable_host
from teleop.console.settings import ConsoleSettings
from teleop.core.errors import UsageError

if TYPE_CHECKING:
    from cryptography import x509

VALID = timedelta(days=397)  # browsers refuse longer ones
LEAST = timedelta(days=7)  # that a kept one must still be valid
CURE = "give a certificate with --certificate and --key"


def with_tls(settings: ConsoleSettings, certificate: Path | None = None, key: Path | None = None) -> ConsoleSettings:
    """The settings with the given certificate and key (PEM), or with those that are made and kept here.

    Raises UsageError for files that are no certificate and its key.
    """
    if certificate is None:
        if key is not None:
            raise UsageError("--key: needs --certificate")
        certificate, key = _kept(_names(settings))
    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(certificate, key)
    except (OSError, ssl.SSLError) as error:
        reason = getattr(error, "reason", None) or getattr(error, "strerror", None) or error
        raise UsageError(f"{certificate}: no certificate with this key: {reason}") from None
    return replace(settings, certificate=str(certificate.resolve()), key=str((key or certificate).resolve()))


def _names(settings: ConsoleSettings) -> Sequence[str]:
    """What the computer is called: host names and addresses."""
    host = socket.gethostname()
    names = {settings.host, reachable_host(settings.host), host, f"{host.partition('.')[0]}.local"}
    return sorted(names - {"0.0.0.0", "::", ""} | {"localhost", "127.0.0.1", "::1"})


def _kept(names: Sequence[str]) -> tuple[Path, Path]:
    folder = state_folder(CURE) / "console"
    certificate, key = folder / "certificate.pem", folder / "key.pem"
    if not (key.is_file() and _is_good(certificate, names)):
        try:
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            texts = _made(names)
            before = os.umask(0o077)
            try:
                write_text(key, texts[1])
                write_text(certificate, texts[0])
            finally:
                os.umask(before)
        except (OSError, OutputError) as error:
            raise UsageError(f"--tls: {error}; {CURE}") from None
    return certificate, key


def _is_good(file: Path, names: Sequence[str]) -> bool:
    """Whether a kept certificate is for all these names, and long enough."""
    from cryptography import x509

    try:
        found = x509.load_pem_x509_certificate(file.read_bytes())
        alternatives = found.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except (OSError, ValueError, x509.ExtensionNotFound):
        return False
    known = {str(each.value) for each in alternatives}
    return set(names) <= known and found.not_valid_after_utc - datetime.now(UTC) > LEAST


def _made(names: Sequence[str]) -> tuple[str, str]:
    """A new certificate and its key, as PEM."""
    from cryptography import x509
    from cryptography.hazmat.primitives import hashes, serialization
    from cryptography.hazmat.primitives.asymmetric import ec
    from cryptography.x509.oid import NameOID

    key = ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "teleop console")])
    now = datetime.now(UTC)
    certificate = (
        x509.CertificateBuilder()
        .subject_name(name)
        .issuer_name(name)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - timedelta(days=1))  # a phone's clock may be late
        .not_valid_after(now + VALID)
        .add_extension(x509.SubjectAlternativeName([_alternative(each) for each in names]), critical=False)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .sign(key, hashes.SHA256())
    )
    secret = key.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    return certificate.public_bytes(serialization.Encoding.PEM).decode(), secret.decode()


def _alternative(name: str) -> x509.GeneralName:
    from cryptography import x509

    try:
        return x509.IPAddress(ipaddress.ip_address(name.partition("%")[0]))
    except ValueError:
        return x509.DNSName(name)
