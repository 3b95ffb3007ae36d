"""A drone on the Onboard SDK: control authority, sticks, telemetry, the checks before a flight."""
