"""The results of a commissioning for the page: three files of one folder, which the command line has chosen."""

from __future__ import annotations

from pathlib import Path

from starlette.requests import Request
from starlette.responses import FileResponse, Response

from teleop.console.json_body import Refusal

NAMES = ("report.html", "report.json", "capture.log", "capture.mcap")
"""All that is ever served of the folder; of the captures there is one."""


class ResultRoutes:
    """Handlers of `/commission`. `folder` is "" where nothing is commissioned."""

    def __init__(self, folder: str) -> None:
        self._folder = folder

    async def download(self, request: Request) -> Response:
        """One of the files, to be kept: a browser does not open it as a page of this console."""
        name = request.path_params["name"]
        file = Path(self._folder) / name
        if not self._folder or name not in NAMES or not file.is_file() or file.is_symlink():
            raise Refusal(404, "no result of that name: they are there once the commissioning is over")
        return FileResponse(file, media_type="application/octet-stream", filename=f"{Path(self._folder).name}-{name}")
