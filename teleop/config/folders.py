"""Where the program keeps files of a user: the folders that the system has for them, XDG's on Linux."""

from __future__ import annotations

from pathlib import Path

from teleop.core.errors import UsageError

NAME = "teleop"


def state_folder(cure: str) -> Path:
    """For what is kept between runs: `$XDG_STATE_HOME/teleop`, else `~/.local/state/teleop`.

    Raises UsageError, which ends with `cure`, where the user has no home directory.
    """
    import platformdirs  # here: most commands need no folder

    return _absolute(platformdirs.user_state_path(NAME, appauthor=False), cure)


def config_folder(cure: str) -> Path:
    """For what a user sets once: `$XDG_CONFIG_HOME/teleop`, else `~/.config/teleop`. Raises as `state_folder` does."""
    import platformdirs

    return _absolute(platformdirs.user_config_path(NAME, appauthor=False), cure)


def _absolute(folder: Path, cure: str) -> Path:
    if not folder.is_absolute():  # its `~` has no meaning
        raise UsageError(f"there is no home directory: {cure}")
    return folder
