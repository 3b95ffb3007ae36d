"""`teleop list` and `teleop copy`: the moves, rigs and pads that come with the program, and how to make one yours.

A shipped sequence names other moves by their bare names only, so a copy of it plays from any folder.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from teleop.config.documents.document import DocumentError
from teleop.config.documents.messages import nearest
from teleop.config.resources import described, folder, is_bare
from teleop.core.errors import DeviceError, UsageError

Kind = Literal["moves", "rigs", "pads"]
FOLDERS: Mapping[Kind, str] = {"moves": "sequences", "rigs": "profiles", "pads": "profiles/pads"}
USES: Mapping[Kind, str] = {
    "moves": "teleop play {}",
    "rigs": "teleop live --rig {}",
    "pads": "in a profile: inputs: [{{pad: {}}}]",
}
"""How a file of each kind is used."""
Json = Annotated[bool, Parameter(name="--json", help="Print JSON, for programs.", negative=(), show_default=False)]


def _offered(_context: object) -> list[tuple[str, str]]:
    """For the tab key: every shipped file's name, and what it is."""
    return [each for place in FOLDERS.values() for each in described(place).items()]


def list_shipped(
    kind: Annotated[Kind | None, Parameter(help="Only these.")] = None,
    /,
    *,
    as_json: Json = False,
) -> None:
    """List the shipped moves, rigs and pads, a line each.

    Pads are joysticks and dials that have a mapping; a live run finds the mapping of a device by itself.
    """
    kinds: list[Kind] = list(FOLDERS) if kind is None else [kind]
    if as_json:
        print(json.dumps({each: entries(each) for each in kinds}))
        return
    print("\n\n".join("\n".join(_lines(each)) for each in kinds))
    print("\nCopy one to edit it: teleop copy NAME FILE.yaml")


def copy(
    name: Annotated[str, Parameter(help="A shipped move, rig or pad: teleop list names them.", completer=_offered)],
    file: Annotated[Path, Parameter(help="The new file, as in mine.yaml.")],
    /,
    *,
    as_json: Json = False,
) -> None:
    """Copy a shipped move, rig or pad to a file that you can edit, comments and all."""
    kind, source = _source(name)
    _refuse(file)
    try:
        with file.open("xb") as target:  # exclusive: never over a file made meanwhile
            target.write(source.read_bytes())
    except FileExistsError:
        raise UsageError(f"{file}: already exists; choose another name") from None
    except OSError as error:
        raise DeviceError(f"{file}: cannot be written: {error.strerror or error}") from None
    if as_json:
        print(json.dumps({"ok": True, "kind": kind, "name": name, "written": str(file)}))
    else:
        print(f"{file}: a copy of {name}. Use it: {USES[kind].format(file)}")


def named(verb: str, file: str | None, as_json: bool) -> str:
    """The move to `verb`. Without one, lists the moves and raises UsageError: nothing was done."""
    if file is not None:
        return file
    problem = f"name a move to {verb}, as in: teleop {verb} reveal"
    if as_json:
        print(json.dumps({"ok": False, "problems": [problem], "moves": entries("moves")}))
    else:
        print("\n".join(_lines("moves")), end="\n\n")
    raise UsageError(problem)


def entries(kind: Kind) -> list[dict[str, str]]:
    """The files of a kind, for programs."""
    place = folder(FOLDERS[kind])
    return [
        {"name": name, "description": description, "path": str(place / f"{name}.yaml")}
        for name, description in described(FOLDERS[kind]).items()
    ]


def _lines(kind: Kind) -> Iterable[str]:
    yield f"{kind.capitalize()} ({USES[kind].format('NAME')}):"
    found = described(FOLDERS[kind])
    for name, description in found.items():
        yield f"  {name:{max(map(len, found))}}  {description}"


def _source(name: str) -> tuple[Kind, Path]:
    """The shipped file of this name. Raises DocumentError with a suggestion."""
    everything: dict[str, Kind] = {each: kind for kind in reversed(list(FOLDERS)) for each in described(FOLDERS[kind])}
    if name in everything:
        return everything[name], folder(FOLDERS[everything[name]]) / f"{name}.yaml"
    if not is_bare(name):
        raise DocumentError([f"{name}: only shipped files are copied, by their bare names; teleop list names them"])
    raise DocumentError([f"{name}: no move, rig or pad of that name is shipped{nearest(name, list(everything))}"])


def _refuse(file: Path) -> None:
    """Raises UsageError where the copy would be of no use, or in the place of something else."""
    if file.is_dir():
        raise UsageError(f"{file}: is a folder; name the file too, as in {file / 'mine.yaml'}")
    if file.exists() or file.is_symlink():
        raise UsageError(f"{file}: already exists; choose another name")
    if file.suffix.lower() not in (".yaml", ".yml"):
        raise UsageError(f"{file}: a file needs its ending, {file.name}.yaml")
    if not file.parent.is_dir():
        raise UsageError(f"{file}: there is no folder {file.parent}")
