"""The gateway process imports all that it will serve before its first word to the door."""

from __future__ import annotations

import json
import subprocess
import sys

CHILD = """
import sys
import teleop.gateway.__main__ as gateway
from teleop.core.errors import TeleopError

class Door:
    def __init__(self, _address): ...
    async def __aenter__(self):
        print(*(name in sys.modules for name in sys.argv[1:]))
        raise TeleopError("seen enough")
    async def __aexit__(self, *_): ...

gateway.DoorClient = Door
gateway.main()
"""


def test_all_is_imported_before_the_first_word_after_which_a_silent_gateway_counts_as_hung() -> None:
    settings = {"door": "/none", "console": {}, "exchange": {"entries": [{"type": "osc"}, {"type": "dfmoco"}]}}
    names = ["teleop.console.server", "teleop.exchange.serving", "teleop.exchange.osc", "teleop.exchange.dfmoco.server"]
    ran = subprocess.run(
        [sys.executable, "-c", CHILD, *names],
        input=json.dumps(settings) + "\n",
        capture_output=True,
        text=True,
        timeout=100,
        check=False,
    )
    assert ran.stdout.split() == ["True"] * 4, ran.stderr
