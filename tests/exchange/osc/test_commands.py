"""What each OSC message asks for; releases of buttons and other people's messages ask for nothing."""

from __future__ import annotations

import math
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.config.exchange.presses import PRESSES
from teleop.core.axes import Axis
from teleop.door.messages import checked
from teleop.exchange.osc.commands import Invalid, command
from teleop.links.osc_packets import Message

AXES = (Axis.PAN, Axis.TILT, Axis.FOCUS)


def asked(address: str, *arguments):
    return command(Message(address, arguments), AXES)


@pytest.mark.parametrize(
    ("message", "wanted"),
    [
        (("/teleop/stop",), {"do": "stop"}),
        (("/teleop/stop", 1.0), {"do": "stop"}),
        (("/teleop/stop", 0), {"do": "stop"}),
        (("/teleop/clear", 1), {"do": "clear"}),
        (("/teleop/goto", 10.0, -5.0, 0.0, 2.0), {"do": "goto", "axes": {"pan": 10.0, "tilt": -5.0}, "seconds": 2.0}),
        (("/teleop/goto", 10, -5, 3), {"do": "goto", "axes": {"pan": 10.0, "tilt": -5.0, "roll": 3.0}}),
        (("/teleop/goto", 0.0, 0.0, 0.0, 0.0), {"do": "goto", "axes": {"pan": 0.0, "tilt": 0.0}}),
        (("/teleop/goto/focus", 0.5, 1), {"do": "goto", "axes": {"focus": 0.5}, "seconds": 1.0}),
        (("/teleop/jog/pan", -1.5, 0.2), {"do": "jog", "axis": "pan", "by": -1.5, "within": 0.2}),
        (("/teleop/jog/tilt", 2), {"do": "jog", "axis": "tilt", "by": 2.0}),
        (("/teleop/jog/pan", 1.0, 0.0), {"do": "jog", "axis": "pan", "by": 1.0}),
        (("/teleop/preset/3",), {"do": "preset_recall", "number": 3}),
        (("/teleop/preset/3", 1.0), {"do": "preset_recall", "number": 3}),
        (("/teleop/preset/3/store",), {"do": "preset_store", "number": 3}),
        (("/teleop/play", "reveal"), {"do": "play", "move": "reveal", "attended": False}),
        (("/teleop/play/reveal", 1), {"do": "play", "move": "reveal", "attended": False}),
        (("/teleop/play", "reveal", "unattended"), {"do": "play", "move": "reveal", "attended": False}),
        (("/teleop/play", "reveal", "attended"), {"do": "play", "move": "reveal", "attended": True}),
        (("/teleop/speed", 0.5), {"do": "speed", "share": 0.5}),
        (("/teleop/record",), {"do": "record"}),
        (("/teleop/stop_recording", True), {"do": "stop_recording"}),
        (("/teleop/shutter", 127), {"do": "shutter"}),
    ],
)
def test_a_message_is_a_command_of_the_door(message, wanted):
    found = asked(*message)
    assert found == wanted
    checked({**wanted, "id": 1, "session": "s"})


@pytest.mark.parametrize(
    "message",
    [
        ("/teleop/record", 0),
        ("/teleop/shutter", 0.0),
        ("/teleop/preset/3", 0.0),
        ("/teleop/play", "reveal", 0.0),
        ("/teleop/clear", False),
        ("/teleop/jog/pan", 0.0),
        ("/teleop/jog/pan", 0.0, 0.5),
        ("/teleop/alive",),
        ("/teleop/state",),
        ("/other/record",),
        ("/teleop",),
    ],
)
def test_a_button_let_go_and_what_is_not_for_us_do_nothing(message):
    assert asked(*message) is None


@pytest.mark.parametrize(
    "message",
    [
        ("/teleop/fly",),
        ("/teleop/*",),
        ("/teleop/st?p",),
        ("/teleop/stop/now",),
        ("/teleop/goto",),
        ("/teleop/goto", 1.0, 2.0),
        ("/teleop/goto", 1.0, 2.0, 3.0, 4.0, 5.0),
        ("/teleop/goto", math.nan, 0.0, 0.0),
        ("/teleop/goto", math.inf, 0.0, 0.0),
        ("/teleop/goto", "a", "b", "c"),
        ("/teleop/goto", 1.0, 2.0, 0.0, -1.0),
        ("/teleop/goto/up", 1.0),
        ("/teleop/jog/pan",),
        ("/teleop/jog", 1.0),
        ("/teleop/jog/pan/tilt", 1.0),
        ("/teleop/jog/pan", 1.0, -1.0),
        ("/teleop/preset/x",),
        ("/teleop/preset/-1",),
        ("/teleop/preset",),
        ("/teleop/play",),
        ("/teleop/play", "reveal", "twice"),
        ("/teleop/speed",),
        ("/teleop/speed", "half"),
    ],
)
def test_what_cannot_be_obeyed_says_so(message):
    with pytest.raises(Invalid):
        asked(*message)


WORDS = ("goto", "jog", "pan", "preset", "1", "play", "speed", "store", *PRESSES, "", "*")


@given(
    st.lists(st.sampled_from(WORDS) | st.text(max_size=4), max_size=4),
    st.lists(st.floats() | st.integers() | st.text(max_size=4) | st.booleans() | st.none() | st.binary(), max_size=5),
)
def test_no_message_raises_anything_else(parts, arguments):
    with suppress(Invalid):
        command(Message("/teleop/" + "/".join(parts), tuple(arguments)), AXES)
