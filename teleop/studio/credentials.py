"""A member's certificate, its key and the access list of its fleet, as `teleop fleet keys` has written them."""

from __future__ import annotations

import ssl
from pathlib import Path
from typing import Any, Literal

from pydantic import Field

from teleop.config.documents.base_model import Section
from teleop.config.documents.yaml_loader import read_document
from teleop.core.errors import UsageError
from teleop.studio.access import access_control

Role = Literal["rig", "watch", "operate", "router"]


class CredentialsFile(Section):
    """What a credentials file has; files in it are seen from its own folder."""

    name: str
    """The common name in the certificate."""
    ca: str
    """Certificate of the fleet's own authority (PEM)."""
    certificate: str
    """The member's certificate (PEM)."""
    key: str
    """The key of the certificate (PEM)."""
    access: str | None = None
    """The access list: who watches, operates, or routes."""


class AccessFile(Section):
    """The access list of a fleet: whoever is not in it can do nothing."""

    members: dict[str, Role] = Field(default_factory=dict)
    """The role of each member, by the common name of its certificate."""


class Credentials:
    """Raises DocumentError and UsageError for files that cannot be used."""

    def __init__(self, file: Path) -> None:
        document = read_document(file)
        found = document.check(CredentialsFile)
        self.name, folder = found.name, file.parent
        self._ca, self._certificate, self._key = (
            _there(folder, each) for each in (found.ca, found.certificate, found.key)
        )
        self.members: dict[str, Role] = {}
        if found.access is not None:
            self.members = read_document(folder / found.access).check(AccessFile).members

    def tls(self) -> dict[str, Any]:
        """Zenoh's settings of TLS."""
        return tls_settings(self._ca, self._certificate, self._key)

    def context(self) -> ssl.SSLContext:
        """Python's TLS with the same certificates, to find out what is wrong with them."""
        context = ssl.create_default_context(cafile=self._ca)
        context.check_hostname = False
        context.load_cert_chain(self._certificate, self._key)
        return context

    def access(self) -> dict[str, Any]:
        """Zenoh's access control for this member's own session."""
        return access_control(self.members)


def tls_settings(ca: str, certificate: str, key: str) -> dict[str, Any]:
    """Zenoh's for files (PEM): both sides show a certificate of the fleet's own authority."""
    return {
        "root_ca_certificate": ca,
        "enable_mtls": True,
        "verify_name_on_connect": False,  # addresses of rigs change; the authority signs members only
        "listen_certificate": certificate,
        "listen_private_key": key,
        "connect_certificate": certificate,
        "connect_private_key": key,
    }


def load(file: str) -> Credentials:
    """The credentials in a file. Raises DocumentError and UsageError."""
    return Credentials(Path(file).expanduser())


def _there(folder: Path, name: str) -> str:
    file = folder / name
    if not file.is_file():
        raise UsageError(f"{file}: there is no such file; make it with `teleop fleet keys`")
    return str(file.resolve())
