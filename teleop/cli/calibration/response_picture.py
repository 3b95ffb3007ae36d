"""The picture of `teleop calibrate`: a page or a drawing."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

from teleop.app.calibration.measure_response import ResponseReport
from teleop.config.files import check_place, replacing
from teleop.core.errors import UsageError

ENDINGS = (".html", ".svg", ".png")


def check_picture(output: Path) -> None:
    """Raises UsageError and OutputError for what cannot be drawn, before anything moves."""
    ending = output.suffix.lower()
    if ending not in ENDINGS:
        raise UsageError(f"-o {output}: its ending must be one of {', '.join(ENDINGS)}")
    if ending != ".html" and find_spec("matplotlib") is None:
        raise UsageError(f"-o {output}: a drawing needs matplotlib: pip install 'rs-teleop[plot]'")
    check_place(output)


def draw_picture(report: ResponseReport, output: Path) -> None:
    """Write it. Raises OutputError."""
    from teleop.plots import response

    traces = [
        response.Trace(
            each.axis,
            each.response,
            [reading.time for reading in each.readings],
            [reading.position for reading in each.readings],
            each.model.tolist(),
        )
        for each in report.axes
    ]
    title = f"{report.key.rig}: how its axes answer, mode {report.key.mode}"
    ending = output.suffix.lower()
    with replacing(output) as stream:
        if ending == ".html":
            stream.write(response.page(title, traces).encode())
        else:
            response.draw(title, traces, stream, ending.removeprefix("."))
