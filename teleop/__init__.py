"""A DJI handheld gimbal, any joystick and a YAML file as a motion-control head."""
