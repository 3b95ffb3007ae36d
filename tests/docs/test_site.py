"""The site, as built: it loads nothing from elsewhere, and its reference has every public name, command and key."""

import re
import subprocess
import sys
from html import unescape
from html.parser import HTMLParser
from pathlib import Path
from types import FunctionType

import pytest

import teleop
from teleop.app.json_schema import KINDS, schema
from teleop.cli import COMMANDS
from teleop.cli.examples import EXAMPLES

ROOT = Path(__file__).parents[2]
LOADED_BY_LINK = {
    "stylesheet",
    "preload",
    "preconnect",
    "prefetch",
    "dns-prefetch",
    "icon",
    "modulepreload",
    "manifest",
}


class Loaded(HTMLParser):
    """What a browser fetches for a page, without a click."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.urls: list[str] = []
        self.ids: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = {name: value or "" for name, value in attrs}
        self.ids.add(values.get("id", ""))
        self.urls += [values[name] for name in ("src", "srcset", "data", "poster") if name in values]
        if tag == "link" and LOADED_BY_LINK & set(values.get("rel", "").split()):
            self.urls.append(values["href"])


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", folder]
    built = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=110, check=False)
    assert built.returncode == 0, built.stderr
    return folder


def text_of(page: Path) -> str:
    """What a reader sees of a page."""
    return unescape(re.sub(r"<[^>]+>", "", page.read_text(encoding="utf-8")))


def words(text: str) -> str:
    """Only letters and digits, a space between: the same in a docstring and on a page."""
    return " ".join(re.findall(r"\w+", text))


def first(docstring: str | None) -> str:
    """The words of a docstring's first paragraph."""
    return words((docstring or "").partition("\n\n")[0])


def test_a_page_loads_nothing_from_elsewhere(site: Path) -> None:
    pages = list(site.rglob("*.html"))
    assert len(pages) > 18
    for page in pages:
        assert [url for url in Loaded(page.read_text(encoding="utf-8")).urls if re.match(r"(https?:)?//", url)] == []
    for sheet in site.rglob("*.css"):
        assert re.findall(r"(?:@import|url\()\s*[\"']?(?:https?:)?//[^)\"']*", sheet.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize("name", teleop.__all__)
def test_the_reference_has_each_public_name_with_its_docstring(site: Path, name: str) -> None:
    page = site / "reference/api.html"
    documented, described = Loaded(page.read_text(encoding="utf-8")).ids, words(text_of(page))
    value = getattr(teleop, name)
    assert f"teleop.{name}" in documented
    assert first(value.__doc__)
    assert first(value.__doc__) in described
    if isinstance(value, type) and not issubclass(value, Exception):
        own = vars(value)
        members = [each for each in (*own, *value.__annotations__) if not each.startswith("_")]
        assert {f"teleop.{name}.{each}" for each in members} <= documented or value is teleop.State
        described_ones = [own[each] for each in members if isinstance(own.get(each), property | FunctionType)]
        assert all(first(each.__doc__) in described for each in described_ones)


def test_the_reference_has_each_command(site: Path) -> None:
    commands = text_of(site / "reference/commands.html")
    for command in (*COMMANDS, *filter(None, EXAMPLES)):
        assert f"Usage: teleop {command} " in commands, command


@pytest.mark.parametrize("kind", KINDS)
def test_the_reference_has_each_key_of_a_file(site: Path, kind: str) -> None:
    keys = text_of(site / "reference/files.html").split()
    whole = schema(kind)
    for section in (whole, *whole.get("$defs", {}).values()):
        assert set(section.get("properties", {})) <= set(keys)
