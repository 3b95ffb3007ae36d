"""Makes docs/how-to/pad-buttons.md out of the shipped mappings: which control is which, with an example for each pad.

    python docs/make_pad_tables.py            writes the page
    python docs/make_pad_tables.py --check    exits with 1 where the page is out of date

What is printed on a pad is in the comments of its mapping, behind each control.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "how-to" / "pad-buttons.md"
PADS = (
    *("xbox", "xbox-bluetooth", "dualsense", "dualshock4", "playstation"),
    *("switch", "8bitdo-pro2", "8bitdo-sn30", "logitech-gamepad", "stadia"),
)
INTRO = """\
# Which button is which

A table for each of the common pads: the name of a control in a profile, what it is on the pad, and what the shipped
mapping has it do. Each example changes two buttons of its pad: one enables motion while it is held, another one pauses
a run. What else a control can do is in [the inputs of a profile](inputs.md). `teleop live --learn` finds the names of a
pad that is not here.
"""
_CONTROL = re.compile(r"^  (\w[\w ]*): *(\{[^}]*\})? *(?:# *(.*))?$", re.MULTILINE)
_FURTHER = re.compile(r"^# (Further buttons: .*)$", re.MULTILINE)


def page() -> str:
    return "\n".join([INTRO, *map(section, PADS)])


def section(pad: str) -> str:
    """The part of the page about one pad."""
    text = (ROOT / "profiles" / "pads" / f"{pad}.yaml").read_text(encoding="utf-8")
    title = text.partition("\n")[0].removeprefix("# ").rstrip(".")
    controls = yaml.safe_load(text)["controls"]
    labels = {name: comment.partition(":")[0] for name, _, comment in _CONTROL.findall(text.partition("controls:")[2])}
    labels["Hat switch"] = "D-pad"
    labels["X"], labels["Y"] = f"{labels['X']}, sideways", f"{labels['X']}, up and down"
    across = next(name for name, control in controls.items() if control.get("axis") == "roll")
    labels[across], other = f"{labels[across]}, sideways", {"Z": "Rz", "Rx": "Ry"}[across]
    rows = [f"| `{name}` | {labels[name]} | {does(control)} |" for name, control in controls.items()]
    rows.insert(3, f"| `{other}` | right stick, up and down | nothing |")
    further = _FURTHER.search(text)
    return "\n".join(
        [
            f"## {title}",
            f"The mapping is `{pad}`.",
            "",
            "| Control | On the pad | What the mapping has it do |",
            "|---|---|---|",
            *rows,
            "",
            *([further[1], ""] if further else []),
            example(pad, controls, labels),
        ]
    )


def does(control: dict) -> str:
    """What a control does, in a few words."""
    if "up" in control:
        numbers = ", ".join(f"{direction} {action['number']}" for direction, action in control.items())
        return f"recalls presets, held stores them: {numbers}"
    moved = control.get("axis") or control.get("press", "")
    return f"{moved}{', inverted' if control.get('invert') else ''}"


def example(pad: str, controls: dict, labels: dict[str, str]) -> str:
    """A profile's entry for the pad, with an enable button."""
    by_press = {control.get("press"): name for name, control in controls.items()}
    slower, recenter = by_press["slower"], by_press["recenter"]
    return f"""\
```yaml rig=sim
inputs:
  - pad: {pad}
    enable: {slower}   # {labels[slower]}: nothing moves unless it is held
    controls:
      {slower}: null   # it is no longer slower
      {recenter}: {{press: pause}}   # {labels[recenter]}
```
"""


def main() -> int:
    if "--check" in sys.argv[1:]:
        return int(PAGE.read_text(encoding="utf-8") != page())
    PAGE.write_text(page(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
