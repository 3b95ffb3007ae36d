"""Which link `teleop monitor` listens on, and what is to be heard there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from teleop.cli.codec.drone_options import cipher_of
from teleop.config.documents.document import DocumentError
from teleop.config.profile import Profile
from teleop.dji.drone.onboard_sdk import MODELS
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.json_record import MakeCipher
from teleop.dji.registry import Registry
from teleop.links import FAR_END, parse
from teleop.links.can import GIMBAL_ID, HOST_ID


@dataclass(frozen=True)
class Tap:
    """A link to listen on: where it is, the far end's name and protocol, and the directions it carries.

    `directions` are by the listener's key for what it received.
    """

    url: str
    device: str
    registry: Registry
    directions: Mapping[int, str]
    cipher: MakeCipher | None = None

    @property
    def is_bus(self) -> bool:
        """Whether both directions arrive, and others' traffic too."""
        return len(self.directions) > 1

    def __str__(self) -> str:
        if self.is_bus:
            return f"{self.url}: time in s, -> to the {self.device}, <- from it"
        return f"{self.url}: time in s, <- from the {self.device}; a serial line does not show what is sent to it"


def tap(profile: Profile, link: str, model: str) -> Tap:
    """What there is to listen on. Raises DocumentError when there is nothing, or no such link."""
    if link and link not in profile.links:
        raise DocumentError([f"{profile.name} has no link {link!r}; it has {', '.join(profile.links)}"])
    heard = [link] if link else sorted(profile.links, key=lambda name: parse(profile.links[name]).kind != "can")
    for name in heard:
        url, device = profile.links[name], "drone" if name in profile.drones else "gimbal"
        registry, cipher = (MODELS[model], cipher_of(None)) if device == "drone" else (R_SDK, None)
        match parse(url).kind:
            case "can":
                return Tap(url, device, registry, {HOST_ID: f"to {device}", GIMBAL_ID: f"from {device}"}, cipher)
            case "serial":
                return Tap(url, device, registry, {FAR_END: f"from {device}"}, cipher)
    places = ", ".join(profile.links[name] for name in heard) or "no link"
    hint = "--link gimbal=socketcan:can0 names one"
    raise DocumentError([f"there is nothing to monitor on {places} (simulated): {hint}"])
