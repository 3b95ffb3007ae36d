"""A DJI handheld gimbal, a joystick and a YAML file as a motion-control head.

For programs: `open`, `plan` and `read_take`, the values they return, and the errors they raise (see `teleop.api`).
Everything else in the package is internal and may change.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from teleop.api import (
        AxisReport,
        BusyError,
        DeviceError,
        DocumentError,
        LinkError,
        Move,
        Report,
        Response,
        Rig,
        Samples,
        State,
        StoppedError,
        Take,
        TeleopError,
        UnplayableError,
        UsageError,
        fleet,
        open,  # noqa: A004 - `teleop.open` reads well
        plan,
        read_take,
    )

    __version__: str

__all__ = [
    "AxisReport",
    "BusyError",
    "DeviceError",
    "DocumentError",
    "LinkError",
    "Move",
    "Report",
    "Response",
    "Rig",
    "Samples",
    "State",
    "StoppedError",
    "Take",
    "TeleopError",
    "UnplayableError",
    "UsageError",
    "fleet",
    "open",
    "plan",
    "read_take",
]


def __getattr__(name: str) -> Any:
    """The API, imported when it is used: the command line pays only for what it needs."""
    if name == "__version__":
        from importlib.metadata import version

        return version("rs-teleop")
    if name in __all__:
        import teleop.api

        return getattr(teleop.api, name)
    raise AttributeError(f"module 'teleop' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
