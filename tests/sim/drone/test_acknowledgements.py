"""A request that comes again byte for byte is acknowledged again and not obeyed again: docs/protocol-facts.md."""

from __future__ import annotations

import pytest

from teleop.dji.frame import Frame
from teleop.sim.drone.acknowledgements import Acknowledgements

REQUEST = Frame(b"\1\0\1", 2, 7)


def test_each_leaves_after_the_delay_in_the_order_it_was_given() -> None:
    acknowledgements = Acknowledgements(0.5)
    acknowledgements.give(b"one", 1.0)
    acknowledgements.give(b"two", 1.25)
    assert acknowledgements.due(1.25) == b""
    assert acknowledgements.due(1.5) == b"one"
    assert acknowledgements.due(9.0) == b"two"
    assert acknowledgements.due(9.0) == b""


@pytest.mark.parametrize(
    ("request_", "seconds", "answer"),
    [
        (REQUEST, 2.0, b"ack"),  # activate is sent 1 s x 3
        (REQUEST, 3.5, None),  # too late: a client with constant sequence numbers means it anew
        (REQUEST._replace(sequence=8), 0.1, None),
        (REQUEST._replace(data=b"\1\0\0"), 0.1, None),
        (REQUEST._replace(cmd_type=3), 0.1, None),  # another session
    ],
)
def test_a_repetition_is_the_same_request_a_moment_later(request_: Frame, seconds: float, answer: bytes | None) -> None:
    acknowledgements = Acknowledgements(0.0)
    acknowledgements.remember(REQUEST, b"ack", 10.0)
    assert acknowledgements.to_repetition(request_, 10.0 + seconds) == answer


def test_each_session_remembers_its_own_request() -> None:
    acknowledgements = Acknowledgements(0.0)
    acknowledgements.remember(REQUEST, b"second", 0.0)
    acknowledgements.remember(REQUEST._replace(cmd_type=3), b"third", 0.0)
    assert acknowledgements.to_repetition(REQUEST, 0.1) == b"second"
    acknowledgements.remember(REQUEST._replace(sequence=8), b"newer", 0.2)
    assert acknowledgements.to_repetition(REQUEST, 0.3) is None


def test_a_drone_that_goes_out_forgets_both() -> None:
    acknowledgements = Acknowledgements(0.5)
    acknowledgements.remember(REQUEST, b"ack", 0.0)
    acknowledgements.give(b"ack", 0.0)
    acknowledgements.forget()
    assert acknowledgements.due(1.0) == b""
    assert acknowledgements.to_repetition(REQUEST, 0.1) is None
