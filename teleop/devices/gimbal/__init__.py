"""A DJI gimbal driven by position, speed or joystick commands."""
