"""The options of a timelapse."""

from __future__ import annotations

import pytest

from teleop.cli.shooting.options import ShootOptions
from teleop.config.documents.document import DocumentError


@pytest.mark.parametrize("options", [ShootOptions(), ShootOptions(resume=True), ShootOptions(in_doubt="skip")])
def test_they_go_with_a_timelapse(options):
    options.check("a.yaml", timelapse=True)


@pytest.mark.parametrize(
    ("options", "name"),
    [
        (ShootOptions(resume=True), "--resume"),
        (ShootOptions(in_doubt="skip"), "--in-doubt"),
        (ShootOptions(by_hand=True), "--by-hand"),
    ],
)
def test_they_go_with_nothing_else(options, name):
    with pytest.raises(DocumentError, match=f"{name}: a.yaml is not a timelapse"):
        options.check("a.yaml", timelapse=False)


def test_one_way_to_begin_at_a_time():
    with pytest.raises(DocumentError, match="--resume and --restart do not go together"):
        ShootOptions(resume=True, restart=True).check("a.yaml", timelapse=True)
    with pytest.raises(DocumentError, match="--rehearse and --by-hand do not go together"):
        ShootOptions(rehearse=True, by_hand=True).check("a.yaml", timelapse=True)
