"""Makes docs/how-to/teleop.companionconfig: a page of buttons for Bitfocus Companion, for its module generic-osc.

    python docs/make_companion.py            writes the file
    python docs/make_companion.py --check    exits with 1 where the file is out of date

The format is that of a page exported by Companion 3.1 to 3.4 (`version` 4), which later ones import too: Companion's
`ExportPageModelv4` and its upgrades from v4. Actions and feedbacks are those of generic-osc 2.x.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any, NamedTuple

ROOT = Path(__file__).parents[1]
FILE = ROOT / "docs" / "how-to" / "teleop.companionconfig"
CONNECTION = "teleop"  # the id that the buttons have for the rig
COMMANDS, FEEDBACK = "9000", "9001"  # UDP ports: the rig's, and Companion's

WHITE, BLACK, RED, DIM_RED, GREEN, BLUE, GRAY, AMBER = (
    *(0xFFFFFF, 0x000000, 0xFF0000, 0x660000, 0x006600, 0x000066, 0x333333, 0xCC8800),
)


class Lit(NamedTuple):
    """When a button is lit: the message of the rig, the number in it, and the color."""

    path: str
    value: int
    color: int


class Button(NamedTuple):
    """`text` is what it shows; `path` and `arguments` are sent when it is pressed."""

    text: str
    path: str
    arguments: str = ""
    color: int = BLACK
    lit: Lit | None = None


def jog(text: str, axis: str, by: float) -> Button:
    return Button(text, f"/teleop/jog/{axis}", f"{by:.1f} 0.5", BLUE)


def speed(share: float) -> Button:
    return Button(f"SPEED\\n{share:.0%}", "/teleop/speed", f"{share:.2f}", GRAY)


ROWS = (
    (
        Button("STOP", "/teleop/stop", "", DIM_RED, Lit("/teleop/stopped", 1, RED)),
        Button("CLEAR\\nSTOP", "/teleop/clear", "", GRAY),
        Button("REC", "/teleop/record", "", DIM_RED, Lit("/teleop/recording", 1, RED)),
        Button("END\\nREC", "/teleop/stop_recording", "", GRAY),
        Button("SHUTTER", "/teleop/shutter", "", GRAY),
        Button("PLAY\\nreveal", "/teleop/play", '"reveal"', GREEN, Lit("/teleop/playing", 1, 0x00CC00)),
        Button("PAUSE", "/teleop/pause", "", GRAY, Lit("/teleop/paused", 1, AMBER)),
        Button("RESUME", "/teleop/resume", "", GRAY),
    ),
    (
        *(Button(f"PRESET\\n{number}", f"/teleop/preset/{number}", "", BLACK) for number in range(1, 6)),
        speed(0.25),
        speed(0.5),
        speed(1.0),
    ),
    (
        jog("PAN\\n-1", "pan", -1),
        jog("PAN\\n+1", "pan", 1),
        jog("TILT\\n-1", "tilt", -1),
        jog("TILT\\n+1", "tilt", 1),
        Button("GO TO\\n0 0 0", "/teleop/goto", "0.0 0.0 0.0 3.0", BLUE),
        jog("PAN\\n-10", "pan", -10),
        jog("PAN\\n+10", "pan", 10),
        Button("ABORT", "/teleop/abort", "", GRAY),
    ),
    tuple(Button(f"STORE\\n{number}", f"/teleop/preset/{number}/store", "", GRAY) for number in range(1, 6)),
)


def page() -> dict[str, Any]:
    controls = {
        str(row): {str(column): control(button, f"{row}{column}") for column, button in enumerate(buttons)}
        for row, buttons in enumerate(ROWS)
    }
    grid = {"minColumn": 0, "maxColumn": 7, "minRow": 0, "maxRow": 3}
    config = {"host": "127.0.0.1", "targetPort": COMMANDS, "protocol": "udp", "listen": True, "feedbackPort": FEEDBACK}
    connection = {
        "instance_type": "generic-osc",
        "label": "teleop",
        "isFirstInit": False,
        "enabled": True,
        "lastUpgradeIndex": 0,
        "config": config,
    }
    return {
        "version": 4,
        "type": "page",
        "page": {"name": "teleop", "controls": controls, "gridSize": grid},
        "instances": {CONNECTION: connection},
        "oldPageNumber": 1,
    }


def control(button: Button, place: str) -> dict[str, Any]:
    style = {
        "text": button.text,
        "textExpression": False,
        "size": "auto",
        "png64": None,
        "alignment": "center:center",
        "pngalignment": "center:center",
        "color": WHITE,
        "bgcolor": button.color,
        "show_topbar": "default",
    }
    sets = {"down": [action(button, f"teleop-a{place}")], "up": []}
    return {
        "type": "button",
        "style": style,
        "options": {"relativeDelay": False, "stepAutoProgress": True, "rotaryActions": False},
        "feedbacks": [] if button.lit is None else [feedback(button.lit, f"teleop-f{place}")],
        "steps": {"0": {"action_sets": sets, "options": {"runWhileHeld": []}}},
    }


def action(button: Button, name: str) -> dict[str, Any]:
    kind, options = "send_blank", {"path": button.path}
    if button.arguments:
        kind, options = "send_multiple", {"path": button.path, "arguments": button.arguments, "sanitise": True}
    return {"id": name, "instance": CONNECTION, "action": kind, "options": options, "delay": 0}


def feedback(lit: Lit, name: str) -> dict[str, Any]:
    options = {"path": lit.path, "arguments": str(lit.value), "comparison": "equal"}
    style = {"color": WHITE, "bgcolor": lit.color}
    return {
        "id": name,
        "instance_id": CONNECTION,
        "type": "osc_feedback_int",
        "options": options,
        "isInverted": False,
        "style": style,
    }


def main() -> int:
    text = json.dumps(page(), indent=1) + "\n"
    if "--check" in sys.argv:
        return int(not FILE.exists() or FILE.read_text(encoding="utf-8") != text)
    FILE.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
