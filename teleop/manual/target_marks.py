"""Where targets are, by looking at them: from one place with a typed distance, or from two places that are known.

The operator aims the camera and types `door,4.2` (m along the lens axis), or at each of two places of the tripod
`door,0,0,0` and `door,1.5,0,0` (m: x right, y forward, z up). The pan's zero must point the same way at both.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable

from teleop.planner.aim import AimError, Point, Sight, at_distance, intersection

NAME = re.compile(r"[a-z][a-z0-9_-]*")
USAGE = "mark target: type NAME,DISTANCE or NAME,X,Y,Z in meters"
DECIMALS = 3  # of a meter
FAR_BY = 0.1  # m that two sights miss each other by, from which on that is said

Found = Callable[[str, Point], object]


class TargetMarks:
    """Keeps the first of two looks; `found` is called with each target's name and place.

    `height` is that of the camera above the point that targets are measured from, in m.
    """

    def __init__(self, height: float, found: Found) -> None:
        self._height, self._found = height, found
        self._first: dict[str, Sight] = {}

    def mark(self, typed: str, pan: float, tilt: float) -> str:
        """What came of a look in this direction (deg), in a line for the operator."""
        name, *numbers = (part.strip() for part in typed.split(","))
        try:
            meters = [float(number) for number in numbers]
        except ValueError:
            return USAGE
        if not NAME.fullmatch(name) or len(meters) not in (1, 3) or not all(map(math.isfinite, meters)):
            return USAGE
        try:
            if len(meters) == 1:
                return self._place(name, at_distance(Sight(Point(0, 0, self._height), pan, tilt), meters[0]))
            return self._look(name, Sight(Point(meters[0], meters[1], meters[2] + self._height), pan, tilt))
        except AimError as error:
            return f"target {name} not marked: {error}"

    def _look(self, name: str, sight: Sight) -> str:
        first = self._first.get(name)
        if first is None or first.camera == sight.camera:
            self._first[name] = sight
            return f"target {name}: seen from here; move the tripod and mark it again from there"
        place, missed = intersection([first, sight])
        del self._first[name]
        far = f"; the two looks miss each other by {missed:.2f} m" if missed > FAR_BY else ""
        return self._place(name, place) + far

    def _place(self, name: str, place: Point) -> str:
        rounded = Point(*(round(value, DECIMALS) + 0.0 for value in place))
        self._found(name, rounded)
        return f"target {name}: {', '.join(f'{value:g}' for value in rounded)} m"
