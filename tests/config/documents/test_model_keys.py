"""The keys at a place of a file, for suggestions."""

from __future__ import annotations

import pytest

from teleop.config.documents.model_keys import keys_at, renamed_at
from teleop.config.profile import Profile


@pytest.mark.parametrize(
    ("location", "has", "lacks"),
    [
        ((), "axes", "velocity"),
        (("axes", "pan"), "velocity", "axes"),
        (("sinks", 0, "gimbal"), "signs", "low_battery"),
        (("sinks", 0, "flight", "full_scale"), "horizontal", "mode"),
    ],
)
def test_keys_are_those_of_the_mapping_at_hand(location, has, lacks):
    keys = keys_at(Profile, location)
    assert has in keys
    assert lacks not in keys


def test_a_place_that_is_no_mapping_has_no_keys():
    assert keys_at(Profile, ("name", "x")) == []


def test_old_keys_are_known_where_they_were():
    assert renamed_at(Profile, ("sinks", 0, "gimbal")) == {"follow": "max_following_error"}
    assert renamed_at(Profile, ("axes", "pan")) == {}
