"""Find turns of phrase that the texts of this project avoid, with what is better.

    python tests/support/banned_turns.py             prints each finding that is not allowed; exits with 1 for any
    python tests/support/banned_turns.py --prune     drops the lines of tests/messages/allowed_turns.txt that are no
                                                     longer found
    python tests/support/banned_turns.py --allow     writes today's findings there; for reviewers, not for new texts

The check reads the texts that users read: those of tests/messages/messages.txt, README, ARCHITECTURE, docs, and the
pages and comments of the shipped profiles and sequences. A line `file: text` in tests/messages/allowed_turns.txt
allows a finding.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path

from list_messages import ROOT, room_of, texts

ALLOWED = ROOT / "tests" / "messages" / "allowed_turns.txt"

TURNS: Mapping[str, str] = {
    r"\b(is|are|was|were|be|been|being) (said|told|heard)\b": "say who does it: `the gimbal reports`, `set`, `sent`",
    r"\btold\b": "sent, commanded, set",
    r"\b(no|any|some)body\b": "name who does, or leave it out",
    r"\bwhoever\b|\bwhosoever\b": "name who",
    r"\bE-?STOP\b": "STOP, or STOPPED",
    r"\bhands off\b": "manual control off",
    r"\bkin\b": "name them, or `similar`",
    r"\bso often\b": "N times",
    r"\b(gives?|given|gave) back\b": "releases, released",
    r"(?<!a )\bstands?\b(?! (still|for)\b)": "is",
    r"\bwants?\b": "needs",
    r"\bwhat is \w+ed\b": "name the thing",
    r"\b(un)?known here\b": "unknown",
    r"\bwhat there is\b|\bthat there is\b": "leave it out",
    r"\b(re-?)?centr(e|es|ed|ing)\b": "center",
    r"\bcolour\w*\b": "color",
    r"\bgrey\w*\b": "gray",
    r"\bprogrammes?\b": "program",
    r"\banalogue\b": "analog",
    r"\b(milli|centi|kilo)?metres?\b": "meter",
    r"\blicence\w*\b": "license",
    r"\bbehaviour\w*\b": "behavior",
    r"\bneighbour\w*\b": "neighbor",
    r"\bcatalogue\w*\b": "catalog",
}
"""Regular expressions, without regard to case, and what to write instead."""

_PLACEHOLDER = re.compile(r"\{[^{}]*\}")  # of a message: names in code are not what users read


def findings() -> Iterator[tuple[str, str, str]]:
    """(file, text, what to write instead) of each text with a banned turn, each text once for all its turns."""
    for file, text in user_texts():
        if better := better_words(text):
            yield file, " ".join(text.split()), better


def user_texts() -> Iterator[tuple[str, str]]:
    """(file, text): the package's messages, and each line of the pages."""
    for file in sorted((ROOT / "teleop").rglob("*.py")):
        for text in texts(file, room_of(file)):
            yield file.relative_to(ROOT).as_posix(), text
    for file in pages():
        for line in file.read_text(encoding="utf-8").splitlines():
            yield file.relative_to(ROOT).as_posix(), line


def pages() -> Iterator[Path]:
    """The files that users read as they are."""
    yield from (file for file in sorted(ROOT.glob("*.md")) if file.name != "LICENSE")
    for folder, pattern in (("docs", "*.md"), ("profiles", "*"), ("sequences", "*"), ("examples", "*.md")):
        yield from (f for f in sorted((ROOT / folder).rglob(pattern)) if f.suffix in (".md", ".yaml"))


def allowed() -> list[str]:
    """The lines `file: text` of the allow-list; lines with # are comments."""
    lines = ALLOWED.read_text(encoding="utf-8").splitlines() if ALLOWED.exists() else []
    return [line for line in lines if line and not line.startswith("#")]


def report(found: Iterable[tuple[str, str, str]], permitted: Collection[str]) -> list[str]:
    """A line for each finding that is not allowed, with what to write instead."""
    return [f"{file}: {text}\n    {better}" for file, text, better in found if f"{file}: {text}" not in permitted]


def better_words(text: str) -> str:
    """What to write instead of the banned turns in a text, or nothing."""
    plain = _PLACEHOLDER.sub("{}", text)
    found = [(match, advice) for turn, advice in TURNS.items() if (match := re.search(turn, plain, re.IGNORECASE))]
    return "; ".join(f"`{match[0]}`: {advice}" for match, advice in found)


def _write(lines: Iterable[str]) -> None:
    head = "# Texts with a banned turn that are allowed or still to be rewritten (file: text). Shorten this list.\n"
    ALLOWED.write_text(head + "".join(f"{line}\n" for line in lines), encoding="utf-8")


def main(arguments: list[str]) -> int:
    """Print what is found; or allow it; or drop what is allowed in vain."""
    found = list(findings())
    lines = list(dict.fromkeys(f"{file}: {text}" for file, text, _ in found))
    if "--allow" in arguments:
        _write(lines)
    if "--prune" in arguments:
        _write(line for line in allowed() if line in lines)
    permitted = allowed()
    new = report(found, permitted)
    used = sum(line in permitted for line in lines)
    summary = f"banned turns: {len(new)} new, {used} allowed, {len(permitted) - used} allowed in vain"
    sys.stdout.write("\n".join([*new, summary]) + "\n")
    return 1 if new else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
