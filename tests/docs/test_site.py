"""The site, as built: it loads nothing from elsewhere, and its reference has every public name, command and key."""

import inspect
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

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
    return re.sub(r"<[^>]+>", "", page.read_text(encoding="utf-8"))


def test_it_has_all_it_should_and_loads_nothing_from_elsewhere(site: Path) -> None:
    pages = list(site.rglob("*.html"))
    assert len(pages) > 18
    for page in pages:
        assert [url for url in Loaded(page.read_text(encoding="utf-8")).urls if re.match(r"(https?:)?//", url)] == []
    for sheet in site.rglob("*.css"):
        assert re.findall(r"(?:@import|url\()\s*[\"']?(?:https?:)?//[^)\"']*", sheet.read_text(encoding="utf-8")) == []

    api = Loaded((site / "reference/api.html").read_text(encoding="utf-8")).ids
    documented = {name.rpartition("teleop.")[2].removeprefix("api.") for name in api}
    for name in teleop.__all__:
        value = getattr(teleop, name)
        assert name in documented
        assert inspect.getdoc(value), name
        if inspect.isclass(value) and not issubclass(value, Exception) and value is not teleop.State:
            members = [each for each in (*vars(value), *value.__annotations__) if not each.startswith("_")]
            assert {f"{name}.{each}" for each in members} <= documented

    commands = text_of(site / "reference/commands.html")
    for command in (*COMMANDS, *filter(None, EXAMPLES)):
        assert f"Usage: teleop {command} " in commands, command

    keys = text_of(site / "reference/files.html")
    for kind in KINDS:
        whole = schema(kind)
        for section in (whole, *whole.get("$defs", {}).values()):
            assert all(key in keys for key in section.get("properties", {}))
