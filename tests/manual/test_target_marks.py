"""A target is where two looks meet, or at a typed distance; whatever is typed, nothing else is taken for one."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.manual.target_marks import USAGE, TargetMarks
from teleop.planner.aim import Point, look_at


class Marks(TargetMarks):
    """With a camera 1.5 m up; `places` are what was found."""

    def __init__(self) -> None:
        self.places: dict[str, Point] = {}
        super().__init__(1.5, self.places.__setitem__)


def test_a_distance_from_one_place_is_enough() -> None:
    marks = Marks()
    assert marks.mark("door,4.2", 90, 0) == "target door: 4.2, 0, 1.5 m"
    assert marks.places == {"door": Point(4.2, 0, 1.5)}


def test_two_known_places_give_the_distance() -> None:
    marks, door = Marks(), Point(4.0, 1.2, 1.6)
    first = marks.mark("door,0,0,0", *look_at(door, Point(0, 0, 1.5)))
    assert first == "target door: seen from here; move the tripod and mark it again from there"
    assert marks.places == {}
    assert marks.mark("door,0,2,0", *look_at(door, Point(0, 2, 1.5))) == "target door: 4, 1.2, 1.6 m"
    assert marks.places == {"door": door}


def test_less_than_5_degrees_of_parallax_is_refused_and_the_first_look_kept() -> None:
    marks, tree = Marks(), Point(0, 30, 2)
    marks.mark("tree,0,0,0", *look_at(tree, Point(0, 0, 1.5)))
    refused = marks.mark("tree,1,0,0", *look_at(tree, Point(1, 0, 1.5)))
    assert refused.startswith("target tree not marked: the two sights differ by 1.9 deg, and 5 are needed")
    assert marks.mark("tree,5,0,0", *look_at(tree, Point(5, 0, 1.5))) == "target tree: 0, 30, 2 m"


def test_a_second_look_from_the_same_place_takes_the_place_of_the_first() -> None:
    marks, door = Marks(), Point(0, 3, 1.5)
    marks.mark("door,0,0,0", 40, 0)
    marks.mark("door,0,0,0", *look_at(door, Point(0, 0, 1.5)))
    assert marks.mark("door,1,0,0", *look_at(door, Point(1, 0, 1.5))) == "target door: 0, 3, 1.5 m"


def test_looks_that_miss_each_other_are_told_so() -> None:
    marks = Marks()
    marks.mark("door,0,0,0", 45, 0)
    assert marks.mark("door,2,0,0.4", -45, 0).endswith("; the two looks miss each other by 0.40 m")


@pytest.mark.parametrize(
    "typed", ["", "door", "door,", "door,x", "4.2", "door,1,2", "door,1,2,3,4", "door,nan", "door,inf", "Door!,1", ",1"]
)
def test_what_is_no_target_gets_the_usage(typed: str) -> None:
    marks = Marks()
    assert marks.mark(typed, 0, 0) == USAGE
    assert marks.places == {}


@given(st.text(alphabet="do-,.0123456789e ", max_size=40), st.floats(-180, 180), st.floats(-90, 90))
def test_no_text_raises(typed: str, pan: float, tilt: float) -> None:
    assert Marks().mark(typed, pan, tilt)
