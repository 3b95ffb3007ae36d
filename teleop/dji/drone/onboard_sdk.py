"""All messages of the drone's Onboard SDK, in a registry for each layout of its broadcast.

An acknowledgement is its value alone: nothing in it says what it answers, so it means something only to whoever knows
the request, by session and sequence. Here lies the difference from the gimbal's replies.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import ModuleType
from typing import Final

from teleop.dji.drone import messages as drone
from teleop.dji.drone import movement, virtual_rc
from teleop.dji.drone.broadcast import A3Broadcast, Broadcast
from teleop.dji.frame import Frame
from teleop.dji.message import Message, Opaque
from teleop.dji.registry import Decoded, Registry, messages_of

SETS: Final = {
    drone.ACTIVATION: "drone.activation",
    drone.CONTROL: "drone.control",
    drone.PUSH: "drone.push",
    virtual_rc.VIRTUAL_RC: "drone.virtual_rc",
}
_MODULES: Final[tuple[ModuleType, ...]] = (drone, movement, virtual_rc)
_OF_ONE_MODEL: Final = {drone.Frequency, drone.A3Frequency, virtual_rc.Exact}
SESSION: Final = 0x1F  # the bits of byte 3 that number the session


class OnboardRegistry(Registry):
    """A Registry whose replies are acknowledgements."""

    replies_have_command = False

    def exchange(self, frame: Frame) -> tuple[int, int]:
        """Session and sequence: what an acknowledgement shares with its request."""
        return frame.cmd_type & SESSION, frame.sequence

    def decode(self, frame: Frame, request: bytes = b"") -> Decoded:
        if not frame.is_reply:
            return super().decode(frame)
        if not frame.data or frame.is_encrypted or len(request) < 2:  # no command has less than its set and id
            return Decoded(Opaque(b"", frame.data), b"")
        for cls in self._classes[True].get(request, ()):
            message = cls.decode(frame.data)
            if not isinstance(message, Opaque):
                return Decoded(message, request)
        return Decoded(Opaque(request, frame.data), request)


def _registry(*of_this_model: type[Message]) -> OnboardRegistry:
    common = [cls for module in _MODULES for cls in messages_of(module) if cls not in _OF_ONE_MODEL]
    names = {cls.set_and_id: cls.name for cls in (drone.Arm, drone.Version)}
    return OnboardRegistry(SETS, (*common, *of_this_model), names=names)


M100: Final = _registry(drone.Frequency, Broadcast)
A3: Final = _registry(drone.A3Frequency, A3Broadcast)
MODELS: Final[Mapping[str, OnboardRegistry]] = {"m100": M100, "a3": A3}
"""By the name that an operator gives; a frame does not report which it is."""
