"""The errors that cross between the stages: each is one line that a user can act on."""

from __future__ import annotations


class TeleopError(Exception):
    """A fault whose text is one line that a user can act on."""


class UsageError(TeleopError):
    """What was typed, or written in a file, cannot be used; nothing has been touched."""


class LinkError(TeleopError):
    """Bytes no longer pass: the adapter is gone, the bus is off or full, the far end is silent."""


class DeviceError(TeleopError):
    """The device answers, and what it says is that it cannot do this."""


class Interrupted(TeleopError):  # noqa: N818 - the user's word for it, as in Ctrl-C
    """The operator ends the run: it stops as smoothly as for a fault, and nothing has failed."""


class LeaveAtOnce(BaseException):
    """The third Ctrl-C or SIGTERM: the run ends now, after one attempt to release every device."""
