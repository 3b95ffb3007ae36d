"""How long another thread may hold up the control thread, while there is one."""

from __future__ import annotations

import sys

import pytest

from teleop.app.switch_interval import SWITCH_INTERVAL, short_switch_interval


def test_it_is_short_until_the_last_of_several_runs_has_ended():
    before = sys.getswitchinterval()
    with short_switch_interval:
        with short_switch_interval:
            pass
        assert sys.getswitchinterval() == pytest.approx(SWITCH_INTERVAL)
    assert sys.getswitchinterval() == before


def test_it_is_put_back_whatever_is_raised():
    before = sys.getswitchinterval()
    with pytest.raises(ZeroDivisionError), short_switch_interval:
        raise ZeroDivisionError
    assert sys.getswitchinterval() == before
