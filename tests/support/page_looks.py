"""How a screen looks, in a way that no font changes: where its parts are, in shares of the screen, and of what colors.

A test that fails prints what is unlike. After a wanted change, `PAGE_LOOKS=write pytest -n 0` on the test keeps the
new look and makes the pictures of the docs.
"""

from __future__ import annotations

from typing import Any

from playwright.sync_api import Page

NEAR = 0.035  # of the screen: a font of another width moves edges by less
DARKER = 24  # of 255, of a color

SCRIPT = """() => {
  const parts = {};
  const shown = (box) => box.width > 0 && box.height > 0 && box.top < innerHeight;
  const color = (text) => (text.match(/[\\d.]+/g) || []).map(Number);
  const kinds = '.card, .stick, .stop, .tabs, .chips, .diamond, .curves, .tile, .attitude';
  for (const each of document.querySelectorAll(kinds)) {
    if (!shown(each.getBoundingClientRect())) continue;
    const kind = [...each.classList].filter((name) => !/^(ink|held|off|pressing)/.test(name)).join('.') || each.tagName;
    const style = getComputedStyle(each), box = each.getBoundingClientRect();
    let name = kind, number = 2;
    while (name in parts) name = `${kind} ${number++}`;
    parts[name] = {
      box: [box.left / innerWidth, box.top / innerHeight, box.width / innerWidth, box.height / innerHeight],
      ink: color(style.color), ground: color(style.backgroundColor),
    };
  }
  return parts;
}"""


def look(page: Page) -> dict[str, Any]:
    parts = page.evaluate(SCRIPT)
    return {
        name: {"box": [round(each, 3) for each in part["box"]], "ink": part["ink"], "ground": part["ground"]}
        for name, part in parts.items()
    }


def unlike(expected: dict[str, Any], found: dict[str, Any]) -> list[str]:
    """A line for each part that is gone, new, elsewhere or of another color."""
    lines = [f"{name} is gone" for name in expected if name not in found]
    lines += [f"{name} is new" for name in found if name not in expected]
    for name in expected.keys() & found.keys():
        old, new = expected[name], found[name]
        if _differ(old["box"], new["box"], NEAR):
            lines.append(f"{name} was at {old['box']}, is at {new['box']}")
        for what in ("ink", "ground"):
            if len(old[what]) != len(new[what]) or _differ(old[what], new[what], DARKER):
                lines.append(f"{name}: {what} was {old[what]}, is {new[what]}")
    return lines


def _differ(old: list[float], new: list[float], most: float) -> bool:
    return any(abs(a - b) > most for a, b in zip(old, new, strict=True))
