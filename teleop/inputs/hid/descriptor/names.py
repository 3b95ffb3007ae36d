"""What usages are called: the words a profile maps by (HID Usage Tables 1.5).

The pages on which things for hands are found are spelled out; a usage that is not here is its page and number, which
maps just as well. A name stands for one usage only, so that a mapping is never in doubt.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from types import MappingProxyType

PAGES: Mapping[int, str] = MappingProxyType(
    {
        0x01: "Generic desktop",
        0x02: "Simulation",
        0x03: "VR",
        0x04: "Sport",
        0x05: "Game",
        0x06: "Generic device",
        0x07: "Keyboard",
        0x08: "LED",
        0x09: "Button",
        0x0A: "Ordinal",
        0x0B: "Telephony",
        0x0C: "Consumer",
        0x0D: "Digitizer",
        0x0E: "Haptics",
        0x0F: "Force feedback",
        0x10: "Unicode",
        0x14: "Display",
        0x20: "Sensor",
        0x40: "Medical",
        0x59: "Lighting",
        0x84: "Power",
        0x85: "Battery",
        0x8C: "Scanner",
        0x90: "Camera control",
    }
)

_BUTTON, _VENDOR = 0x09, 0xFF00  # vendors have the pages from there on


def _run(first: int, *names: str) -> dict[int, str]:
    return dict(enumerate(names, first))


_DESKTOP = {
    **_run(0x01, "Pointer", "Mouse"),
    **_run(0x04, "Joystick", "Gamepad", "Keyboard", "Keypad", "Multi-axis controller"),
    **_run(0x0E, "System multi-axis controller"),
    **_run(0x30, "X", "Y", "Z", "Rx", "Ry", "Rz", "Slider", "Dial", "Wheel", "Hat switch", "Counted buffer"),
    **_run(0x3B, "Byte count", "Motion wakeup", "Start", "Select"),
    **_run(0x40, "Vx", "Vy", "Vz", "Vbrx", "Vbry", "Vbrz", "Vno", "Feature notification", "Resolution multiplier"),
    **_run(0x49, "Qx", "Qy", "Qz", "Qw"),
    **_run(0x80, "System control", "System power down", "System sleep", "System wake up", "System context menu"),
    **_run(0x85, "System main menu", "System app menu", "System menu help", "System menu exit", "System menu select"),
    **_run(0x8A, "System menu right", "System menu left", "System menu up", "System menu down"),
    **_run(0x8E, "System cold restart", "System warm restart"),
    **_run(0x90, "D-pad up", "D-pad down", "D-pad right", "D-pad left", "Index trigger", "Palm trigger", "Thumbstick"),
    **_run(0xA0, "System dock", "System undock", "System setup", "System break"),
}

_SIMULATION = {
    **_run(0xB0, "Aileron", "Aileron trim", "Anti-torque", "Autopilot enable", "Chaff release", "Collective"),
    **_run(0xB6, "Dive brake", "Electronic countermeasures", "Elevator", "Elevator trim", "Rudder", "Throttle"),
    **_run(0xBC, "Flight communications", "Flare release", "Landing gear", "Toe brake", "Trigger", "Weapons arm"),
    **_run(0xC2, "Weapons select", "Wing flaps", "Accelerator", "Brake", "Clutch", "Shifter", "Steering"),
    **_run(0xC9, "Turret direction", "Barrel elevation", "Dive plane", "Ballast", "Bicycle crank", "Handle bars"),
    **_run(0xCF, "Front brake", "Rear brake"),
}

_GAME = {
    **_run(0x20, "Point of view", "Turn right/left", "Pitch forward/backward", "Roll right/left"),
    **_run(
        0x24, "Move right/left", "Move forward/backward", "Move up/down", "Lean right/left", "Lean forward/backward"
    ),
    **_run(0x29, "POV height", "Flipper", "Secondary flipper", "Bump", "New game", "Shoot ball", "Player"),
    **_run(0x30, "Gun bolt", "Gun clip", "Gun selector", "Gun single shot", "Gun burst", "Gun automatic"),
    **_run(0x36, "Gun safety", "Gamepad fire/jump", "Gamepad trigger"),
}

_DEVICE = {
    **_run(0x20, "Battery strength", "Wireless channel", "Wireless id", "Discover wireless control"),
    **_run(0x24, "Security code entered", "Security code erased", "Security code cleared"),
}

_CONSUMER = {
    **_run(0x01, "Consumer control", "Numeric key pad", "Programmable buttons"),
    **_run(0x30, "Power", "Reset", "Sleep"),
    **_run(0x40, "Menu", "Menu pick", "Menu up", "Menu down", "Menu left", "Menu right", "Menu escape"),
    **_run(0x47, "Menu value increase", "Menu value decrease"),
    **_run(0x6F, "Brightness increment", "Brightness decrement"),
    **_run(0xB0, "Play", "Pause", "Record", "Fast forward", "Rewind", "Next track", "Previous track", "Stop", "Eject"),
    **_run(0xB9, "Random play"),
    **_run(0xBC, "Repeat"),
    **_run(0xCC, "Stop/eject", "Play/pause", "Play/skip", "Voice command"),
    **_run(0xE0, "Volume", "Balance", "Mute", "Bass", "Treble"),
    **_run(0xE9, "Volume increment", "Volume decrement"),
    0x183: "Media player",
    0x18A: "Email",
    0x192: "Calculator",
    0x194: "Local browser",
    **_run(0x200, "Generic GUI controls", "AC new", "AC open", "AC close", "AC exit"),
    **_run(0x207, "AC save", "AC print"),
    **_run(0x21A, "AC undo", "AC copy", "AC cut", "AC paste", "AC select all", "AC find"),
    **_run(0x221, "AC search"),
    **_run(0x223, "AC home", "AC back", "AC forward", "AC stop", "AC refresh"),
    **_run(0x22A, "AC bookmarks"),
    **_run(0x22D, "AC zoom in", "AC zoom out", "AC zoom"),
    **_run(0x233, "AC scroll up", "AC scroll down", "AC scroll"),
    **_run(0x236, "AC pan left", "AC pan right", "AC pan"),
}

_DIGITIZER = {
    **_run(0x01, "Digitizer", "Pen", "Light pen", "Touch screen", "Touch pad"),
    0x0E: "Device configuration",
    **_run(0x20, "Stylus", "Puck", "Finger"),
    **_run(0x30, "Tip pressure", "Barrel pressure", "In range", "Touch", "Untouch", "Tap", "Quality", "Data valid"),
    **_run(0x38, "Transducer index", "Tablet function keys", "Program change keys", "Battery level", "Invert"),
    **_run(0x3D, "X tilt", "Y tilt", "Azimuth", "Altitude", "Twist", "Tip switch", "Secondary tip switch"),
    **_run(0x44, "Barrel switch", "Eraser", "Tablet pick", "Touch valid", "Touch width", "Touch height"),
    **_run(0x51, "Contact id", "Device mode", "Device identifier", "Contact count", "Contact count maximum"),
    0x56: "Scan time",
    **_run(0x5A, "Secondary barrel switch", "Transducer serial number"),
}

_KEYS = {
    **_run(0x04, *(f"Key {letter}" for letter in "ABCDEFGHIJKLMNOPQRSTUVWXYZ1234567890")),
    **_run(
        0x28, "Key enter", "Key escape", "Key backspace", "Key tab", "Key space", "Key -", "Key =", "Key [", "Key ]"
    ),
    **_run(0x31, "Key backslash", "Key non-US #", "Key ;", "Key '", "Key `", "Key comma", "Key .", "Key /"),
    **_run(0x39, "Key caps lock", *(f"Key F{number}" for number in range(1, 13))),
    **_run(0x46, "Key print screen", "Key scroll lock", "Key pause", "Key insert", "Key home", "Key page up"),
    **_run(0x4C, "Key delete", "Key end", "Key page down", "Key right", "Key left", "Key down", "Key up"),
    **_run(0x53, "Key num lock", "Keypad /", "Keypad *", "Keypad -", "Keypad +", "Keypad enter"),
    **_run(0x59, *(f"Keypad {digit}" for digit in "1234567890"), "Keypad .", "Key non-US backslash"),
    **_run(0x65, "Key application", "Key power", "Keypad =", *(f"Key F{number}" for number in range(13, 25))),
    **_run(0x7F, "Key mute", "Key volume up", "Key volume down"),
    **_run(0xE0, "Left control", "Left shift", "Left alt", "Left GUI"),
    **_run(0xE4, "Right control", "Right shift", "Right alt", "Right GUI"),
}

USAGES: Mapping[int, Mapping[int, str]] = MappingProxyType(
    {
        0x01: _DESKTOP,
        0x02: _SIMULATION,
        0x05: _GAME,
        0x06: _DEVICE,
        0x07: _KEYS,
        0x0C: _CONSUMER,
        0x0D: _DIGITIZER,
    }
)


@lru_cache(maxsize=4096)
def usage_name(page: int, usage: int) -> str:
    """`X`, `Hat switch` or `Button 3`; `Vendor 0xff00:0x20` and `Consumer 0xc:0x99` for what has no name here."""
    if page == _BUTTON and usage:
        return f"Button {usage}"
    if name := USAGES.get(page, {}).get(usage):
        return name
    return f"{PAGES.get(page, 'Vendor' if page >= _VENDOR else 'Page')} {page:#x}:{usage:#x}"
