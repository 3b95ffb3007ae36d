"""The certificates of a fleet: an authority of its own, made once, and a certificate for each rig, operator and router.

A rig and a router serve and connect; an operator's certificate only connects, so nobody can pretend with it to be a
rig. Every key is readable by its owner alone. Keys are moved to their machines by hand; the authority's stays.
"""

from __future__ import annotations

import os
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from teleop.config.documents.yaml_loader import read_document
from teleop.core.errors import UsageError
from teleop.studio.access import access_control
from teleop.studio.credentials import AccessFile, Role, tls_settings
from teleop.studio.transport import KEEP_ALIVES, LEASE

if TYPE_CHECKING:
    from cryptography import x509
    from cryptography.hazmat.primitives.asymmetric import ec

VALID = timedelta(days=3650)  # of the authority and what it signs: a rig must not go silent in the middle of a series
EARLY = timedelta(days=1)  # before now: a machine's clock may be late
ACCESS, AUTHORITY, ROUTER = "access.yaml", "ca", "router.json5"
PORT = 7447


def require() -> None:
    """Raises UsageError where `cryptography` is not installed."""
    try:
        import cryptography  # noqa: F401 - only whether it is there
    except ImportError:
        raise UsageError("keys need the package cryptography: pip install 'rs-teleop[fleet]'") from None


class KeyFolder:
    """The folder in which the authority and the access list of a fleet are. Raises UsageError and DocumentError."""

    def __init__(self, folder: Path) -> None:
        require()
        self.folder = folder
        try:
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        except OSError as error:
            raise UsageError(f"{folder}: {error.strerror or error}") from None
        access = folder / ACCESS
        self.members: dict[str, Role] = read_document(access).check(AccessFile).members if access.exists() else {}
        self._authority = self._loaded() if (folder / f"{AUTHORITY}.key").exists() else self._founded()

    def add(self, name: str, role: Role, serves: bool) -> Path:
        """A certificate, a key and a credentials file for a new member; the credentials file.

        `serves`: it listens, as rigs and routers do. Raises UsageError for a name that has them already.
        """
        file = self.folder / f"{name}.yaml"
        if name in (AUTHORITY, "access") or file.exists() or name in self.members:
            raise UsageError(f"{name}: has keys already, or its files would replace others; choose another name")
        certificate, key = _member(name, serves, *self._authority)
        self._write(f"{name}.pem", _pem(certificate))
        self._write(f"{name}.key", _secret(key))
        self.members[name] = role
        self.write_access()
        found = {"name": name, "ca": f"{AUTHORITY}.pem", "certificate": f"{name}.pem", "key": f"{name}.key"}
        self._write(f"{name}.yaml", _yaml({**found, **({"access": ACCESS} if serves else {})}))
        self.write_routers()
        return file

    def write_routers(self) -> list[Path]:
        """The configuration of each router anew, for the members that there are by now; the files."""
        names = sorted(name for name, role in self.members.items() if role == "router")
        for name in names:
            self._write(f"{name}.{ROUTER}", router_settings(name, self.members))
        return [self.folder / f"{name}.{ROUTER}" for name in names]

    def _loaded(self) -> tuple[x509.Certificate, ec.EllipticCurvePrivateKey]:
        from cryptography import x509
        from cryptography.hazmat.primitives import serialization

        try:
            certificate = x509.load_pem_x509_certificate((self.folder / f"{AUTHORITY}.pem").read_bytes())
            key: Any = serialization.load_pem_private_key((self.folder / f"{AUTHORITY}.key").read_bytes(), None)
        except (OSError, ValueError) as error:
            raise UsageError(f"{self.folder / AUTHORITY}: is no certificate with its key: {error}") from None
        return certificate, key

    def _founded(self) -> tuple[x509.Certificate, ec.EllipticCurvePrivateKey]:
        certificate, key = _authority()
        self._write(f"{AUTHORITY}.key", _secret(key))
        self._write(f"{AUTHORITY}.pem", _pem(certificate))
        return certificate, key

    def write_access(self) -> None:
        """The access list of the members that there are by now."""
        head = "# Roles: rig, watch, operate or router. All others can do nothing. Copy it to every rig.\n"
        self._write(ACCESS, head + _yaml({"members": dict(self.members)}))

    def _write(self, name: str, text: str) -> None:
        """Mode 0600 from the beginning; an old file is replaced as a whole."""
        file, new = self.folder / name, self.folder / f".{name}.new"
        try:
            new.unlink(missing_ok=True)
            descriptor = os.open(new, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
            with os.fdopen(descriptor, "w", encoding="utf-8") as stream:
                stream.write(text)
            new.replace(file)
        except OSError as error:
            raise UsageError(f"{file}: cannot be written: {error.strerror or error}") from None


def router_settings(name: str, members: dict[str, Role]) -> str:
    """The configuration of a router, for `zenohd -c`: JSON5 with TLS and the access list."""
    import json

    access = access_control(members)
    settings = {
        "mode": "router",
        "listen": {"endpoints": [f"tls/0.0.0.0:{PORT}"]},
        "scouting": {"multicast": {"enabled": False}, "gossip": {"enabled": False}},
        "transport": {
            "link": {
                "protocols": ["tls"],
                "tx": {"lease": LEASE, "keep_alive": KEEP_ALIVES},
                "tls": tls_settings(f"{AUTHORITY}.pem", f"{name}.pem", f"{name}.key"),
            }
        },
        "access_control": access,
    }
    head = f"// Made by `teleop fleet keys`: run it in this folder, as in zenohd -c {name}.{ROUTER}"
    return f"{head}\n{json.dumps(settings, indent=2)}\n"


def _authority() -> tuple[x509.Certificate, ec.EllipticCurvePrivateKey]:
    from cryptography import x509
    from cryptography.hazmat.primitives.asymmetric import ec

    key = ec.generate_private_key(ec.SECP256R1())
    name = _name("teleop fleet")
    builder = _builder(name, name, key.public_key()).add_extension(
        x509.BasicConstraints(ca=True, path_length=0), critical=True
    )
    return _signed(builder.add_extension(_usage(signs=True), critical=True), key), key


def _member(
    name: str, serves: bool, authority: x509.Certificate, signing: ec.EllipticCurvePrivateKey
) -> tuple[x509.Certificate, ec.EllipticCurvePrivateKey]:
    from cryptography import x509
    from cryptography.hazmat.primitives.asymmetric import ec
    from cryptography.x509.oid import ExtendedKeyUsageOID

    key = ec.generate_private_key(ec.SECP256R1())
    uses = [ExtendedKeyUsageOID.CLIENT_AUTH, *([ExtendedKeyUsageOID.SERVER_AUTH] if serves else [])]
    builder = (
        _builder(_name(name), authority.subject, key.public_key())
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(_usage(signs=False), critical=True)
        .add_extension(x509.ExtendedKeyUsage(uses), critical=False)
        .add_extension(x509.SubjectAlternativeName([x509.DNSName(name)]), critical=False)
        .add_extension(x509.AuthorityKeyIdentifier.from_issuer_public_key(signing.public_key()), critical=False)
    )
    return _signed(builder, signing), key


def _builder(subject: x509.Name, issuer: x509.Name, key: ec.EllipticCurvePublicKey) -> x509.CertificateBuilder:
    from cryptography import x509

    now = datetime.now(UTC)
    return (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(issuer)
        .public_key(key)
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - EARLY)
        .not_valid_after(now + VALID)
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(key), critical=False)
    )


def _signed(builder: x509.CertificateBuilder, key: ec.EllipticCurvePrivateKey) -> x509.Certificate:
    from cryptography.hazmat.primitives import hashes

    return builder.sign(key, hashes.SHA256())


def _name(text: str) -> x509.Name:
    from cryptography import x509
    from cryptography.x509.oid import NameOID

    return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, text)])


def _usage(signs: bool) -> x509.KeyUsage:
    from cryptography import x509

    nothing = (
        "content_commitment",
        "key_encipherment",
        "data_encipherment",
        "key_agreement",
        "encipher_only",
        "decipher_only",
    )
    return x509.KeyUsage(
        digital_signature=not signs, key_cert_sign=signs, crl_sign=signs, **dict.fromkeys(nothing, False)
    )


def _pem(certificate: x509.Certificate) -> str:
    from cryptography.hazmat.primitives import serialization

    return certificate.public_bytes(serialization.Encoding.PEM).decode()


def _secret(key: ec.EllipticCurvePrivateKey) -> str:
    from cryptography.hazmat.primitives import serialization as pem

    return key.private_bytes(pem.Encoding.PEM, pem.PrivateFormat.PKCS8, pem.NoEncryption()).decode()


def _yaml(content: dict[str, Any]) -> str:
    return yaml.safe_dump(content, sort_keys=False)
