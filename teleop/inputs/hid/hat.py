"""A hat switch: where it points, which value is its rest, and which direction a press of it means.

Most descriptors say what rest is: a null state, or a value out of the range. Some count it among the values (0..8 with
8 at rest, or with 0); then the first value that can be the rest is taken for it, and until one has come the hat points
nowhere. A thumb that rolls over a diagonal means the direction where it began: that one counts until the hat is back at
rest. A diagonal straight from rest means neither.
"""

from __future__ import annotations

from teleop.inputs.hid.descriptor.report import Control

HAT = (0x01, 0x39)
DIRECTIONS = (("up", 0), ("right", 90), ("down", 180), ("left", 270))
WITHIN = 60  # degrees: of eight places the two next to a direction count for it as well
PLACES = (4, 8)  # of hats whose range has directions only


def points_to(angle: float | None, at: int, within: float = WITHIN) -> bool:
    """Whether `angle` is that of the direction at `at` degrees, or next to it."""
    return angle is not None and abs((angle - at + 180) % 360 - 180) < within


class Hat:
    """`first` is the direction that a press of it means, "" at rest."""

    def __init__(self) -> None:
        self.first = ""
        self._rest: int | None = None

    def angle(self, control: Control) -> float | None:
        """Degrees clockwise from up, None at rest."""
        angle = self._angle(control)
        if angle is None:
            self.first = ""
        elif not self.first:
            self.first = next((name for name, at in DIRECTIONS if points_to(angle, at, 1)), "")
        return angle

    def _angle(self, control: Control) -> float | None:
        low, high, value = control.minimum, control.maximum, control.value
        places = high - low + 1
        if control.null or not low <= value <= high or places <= 1:
            return None
        if places in PLACES:
            return (value - low) * 360 / places
        directions = 4 if places <= 5 else 8
        if self._rest is None:
            if low < value < low + directions:
                return None  # held while it was plugged in: its rest is still to come
            self._rest = value
        begin = low + 1 if self._rest == low else low
        place = value - begin
        return place * 360 / directions if value != self._rest and 0 <= place < directions else None
