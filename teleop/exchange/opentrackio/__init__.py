"""OpenTrackIO: the camera's attitude for all that joins its multicast group, or a tracker's for the rig to follow."""

from __future__ import annotations

from teleop.config.exchange.opentrackio import OpenTrackIOSection
from teleop.core.errors import UsageError
from teleop.exchange.served import Served


async def serve(section: OpenTrackIOSection, served: Served) -> None:
    """Send or follow until cancelled. Raises TeleopError where the receiver's host is unknown."""
    try:
        import cbor2  # noqa: F401 - only whether it is there
    except ImportError:
        raise UsageError("it needs a package: pip install 'rs-teleop[exchange]'") from None
    from teleop.exchange.opentrackio.following import receive
    from teleop.exchange.opentrackio.sending import send

    if section.to is not None:
        await send(section, section.to, served)
    elif section.listen is not None:
        await receive(section, section.listen, served)
