"""A receiver of the feedback that cannot be."""

from __future__ import annotations

import asyncio

import pytest
from fake_served import FakeServed

from teleop.config.exchange.osc import OscSection
from teleop.core.errors import TeleopError
from teleop.exchange.osc import server


def test_a_host_name_that_cannot_be_one_is_an_error_by_which_the_entry_is_served_again() -> None:
    section = OscSection(type="osc", to="studio..desk:9000")
    with pytest.raises(TeleopError, match="unknown host"):
        asyncio.run(server.serve(section, FakeServed().served))
