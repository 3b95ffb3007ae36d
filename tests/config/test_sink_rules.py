"""The rules between a profile's sinks."""

from __future__ import annotations

import pytest

from teleop.config.sink_rules import sink_rules

GIMBAL = {"type": "gimbal", "link": "gimbal", "mode": "position", "rate": 50}
FLIGHT = {"type": "flight", "link": "drone", "mode": "velocity-body", "full_scale": {"horizontal": 1}}
ON_DRONES_LINK = {**GIMBAL, "link": "drone"}


def profile(*sinks, axes=("pan",), **more):
    limits = {axis: {"velocity": 10, "min": -1, "max": 1} for axis in axes}
    return {"links": {"gimbal": "sim:", "drone": "sim:"}, "axes": limits, "sinks": list(sinks), **more}


def found(data):
    return [(location, text) for location, text in sink_rules(data)]


def test_a_sound_profile_has_no_problem():
    assert found(profile(GIMBAL)) == []
    assert found(profile(FLIGHT, axes=("stick_roll",))) == []


@pytest.mark.parametrize(
    ("data", "location", "words"),
    [
        (
            profile({**GIMBAL, "link": "can"}),
            ("sinks", 0, "link"),
            "must be one of the links (gimbal, drone)",
        ),
        (profile(GIMBAL, GIMBAL), ("sinks", 1), "pan is already driven by sinks[0]"),
        (profile(GIMBAL, axes=("pan", "focus")), ("axes", "focus"), "no sink drives it"),
        (profile(GIMBAL, {"type": "focus", "link": "gimbal"}), ("sinks", 1), "it drives focus"),
        (profile({**GIMBAL, "mode": "speed", "rate": 2}), ("sinks", 0, "rate"), "must be at least 5"),
        (profile({**GIMBAL, "full_stick": {"pan": 5}}), ("axes", "pan", "velocity"), "must be at most 5"),
        (
            profile(FLIGHT, ON_DRONES_LINK, axes=("stick_roll", "pan")),
            ("sinks", 0, "link"),
            "drone's alone",
        ),
        (
            profile({**FLIGHT, "full_scale": {"horizontal": 1000}}, axes=("stick_roll",)),
            ("sinks", 0, "full_scale", "horizontal"),
            "must be at most",
        ),
        (profile(FLIGHT, axes=("stick_roll",), links={"drone": "socketcan:can0"}), ("links", "drone"), "serial line"),
    ],
)
def test_a_mistake_is_found_at_its_place(data, location, words):
    assert any(place == location and words in text for place, text in found(data)), found(data)


def test_a_stick_has_its_center_between_its_limits():
    data = profile(FLIGHT, axes=("stick_roll",))
    data["axes"]["stick_roll"]["min"] = 0.2
    assert any("its center 0 between them" in text for _, text in found(data))
