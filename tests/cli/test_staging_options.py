"""How a move is begun, repeated and ended, by options."""

from __future__ import annotations

import math

import pytest

from teleop.app.planning import plan_content
from teleop.cli.staging_options import StagingOptions
from teleop.cli.typed_triggers import joined
from teleop.config.profile import load_profile
from teleop.core.clock import SystemClock, VirtualClock
from teleop.core.errors import UsageError


@pytest.fixture(scope="module")
def sequence():
    keys = [{"at": 0, "pan": 0}, {"at": 2, "pan": 10}, {"at": 4, "pan": 0}]
    return plan_content({"keyframes": keys, "preroll": "1s"}, load_profile("sim")).sequence


def cycle(sequence, **options):
    return StagingOptions(**options).staging(sequence, SystemClock(), keys=False)


def test_without_options_it_is_the_sequences_own(sequence):
    found = cycle(sequence)
    assert (found.preroll, found.start_at, found.passes, found.back_to_one) == (1, 0, 1, False)


def test_options_replace_it(sequence):
    found = cycle(sequence, preroll="3s", start_at="key2", passes=4, back_to_one=True)
    assert (found.preroll, found.start_at, found.passes, found.back_to_one) == (3, 2, 4, True)
    assert cycle(sequence, loop=True).passes == math.inf


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"passes": 0}, "--passes: must be at least 1"),
        ({"passes": 2, "loop": True}, "--passes: leave out --loop"),
        ({"start_at": "key9"}, r"there is key1\.\.key3"),
        ({"start_at": "4"}, "the move ends at 4 s"),
        ({"start_at": "soon"}, "--start-at soon: must be a time"),
        ({"preroll": "-1s"}, "--preroll -1s"),
        ({"trigger": "key"}, "no terminal"),
    ],
)
def test_what_the_move_has_not_is_refused(sequence, options, words):
    with pytest.raises(UsageError, match=words):
        cycle(sequence, **options)


def test_a_trigger_needs_real_time(sequence):
    with pytest.raises(UsageError, match="leave out --fast"):
        StagingOptions(trigger="key").staging(sequence, VirtualClock(), keys=True)


@pytest.mark.parametrize(
    ("typed", "found"),
    [
        (["--trigger", "time", "18:30:00"], ["--trigger", "time:18:30:00"]),
        (["--trigger=osc", "9000/go"], ["--trigger=osc:9000/go"]),
        (["--trigger", "key", "reveal"], ["--trigger", "key", "reveal"]),
        (["--trigger", "time", "reveal"], ["--trigger", "time", "reveal"]),
    ],
)
def test_a_trigger_of_two_words_is_joined(typed, found):
    assert joined(typed) == found
