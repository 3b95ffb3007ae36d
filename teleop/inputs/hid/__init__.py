"""HID joysticks, gamepads and dials: found, read, mapped to axes and commands."""
