"""Where to look to see a point, and where a point is that was looked at; by the geometry of the field's own axes."""

from __future__ import annotations

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from teleop.planner.aim import AimError, Point, Sight, at_distance, intersection, look_at, nearest_turn

meters = st.floats(-20, 20)
points = st.builds(Point, meters, meters, meters)
ORIGIN = Point(0, 0, 0)


@pytest.mark.parametrize(
    ("target", "pan", "tilt"),
    [
        ((0, 5, 0), 0, 0),
        ((5, 5, 0), 45, 0),
        ((5, 0, 0), 90, 0),
        ((-5, 0, 0), -90, 0),
        ((0, 5, 5), 0, 45),
        ((0, 5, -5), 0, -45),
        ((0, -5, 0), 180, 0),
        ((3, 4, 5), math.degrees(math.atan(3 / 4)), 45),
    ],
)
def test_right_is_a_positive_pan_and_up_a_positive_tilt(
    target: tuple[float, float, float], pan: float, tilt: float
) -> None:
    assert look_at(Point(*target), ORIGIN) == pytest.approx((pan, tilt))


def test_a_target_at_the_camera_has_no_direction() -> None:
    with pytest.raises(AimError, match="the target is where the camera is"):
        look_at(Point(1, 2, 3), Point(1, 2, 3.005))


@given(points, points)
def test_a_point_is_found_again_from_a_look_and_its_distance(target: Point, camera: Point) -> None:
    distance = math.dist(target, camera)
    assume(distance > 0.1)
    assert at_distance(Sight(camera, *look_at(target, camera)), distance) == pytest.approx(target, abs=1e-6)


@given(points, points, points)
def test_a_point_is_found_again_from_two_places_that_are_apart(target: Point, first: Point, second: Point) -> None:
    sides = math.dist(target, first), math.dist(target, second), math.dist(first, second)
    assume(min(sides) > 0.1)
    angle = math.degrees(math.acos((sides[0] ** 2 + sides[1] ** 2 - sides[2] ** 2) / (2 * sides[0] * sides[1])))
    assume(5.01 < angle < 174.9)
    found, missed = intersection([Sight(camera, *look_at(target, camera)) for camera in (first, second)])
    assert found == pytest.approx(target, abs=1e-4)
    assert missed == pytest.approx(0, abs=1e-4)


def test_two_sights_that_are_too_much_alike_are_refused() -> None:
    target = Point(0, 10, 0)
    sights = [Sight(camera, *look_at(target, camera)) for camera in (ORIGIN, Point(0.5, 0, 0))]
    with pytest.raises(AimError, match=r"differ by 2\.9 deg, and 5 are needed: look from further apart"):
        intersection(sights)


def test_two_sights_that_part_meet_nowhere_in_front() -> None:
    with pytest.raises(AimError, match="behind the camera"):
        intersection([Sight(ORIGIN, -20, 0), Sight(Point(1, 0, 0), 20, 0)])


def test_the_two_sights_need_not_meet_exactly() -> None:
    found, missed = intersection([Sight(ORIGIN, 45, 0), Sight(Point(2, 0, 0.1), -45, 0)])
    assert found == pytest.approx((1, 1, 0.05))
    assert missed == pytest.approx(0.1)


@pytest.mark.parametrize("distance", [0, -1, math.nan])
def test_a_distance_of_nothing_is_refused(distance: float) -> None:
    with pytest.raises(AimError, match="distance"):
        at_distance(Sight(ORIGIN, 0, 0), distance)


@pytest.mark.parametrize(("pan", "near", "turn"), [(170, -170, -190), (-170, 170, 190), (0, 720, 720), (10, 20, 10)])
def test_the_nearest_turn(pan: float, near: float, turn: float) -> None:
    assert nearest_turn(pan, near) == pytest.approx(turn)
