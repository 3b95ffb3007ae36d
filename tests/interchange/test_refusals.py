"""Files that are broken, foreign or meant to do harm: refused in one line with the place, or read as they are meant."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from made_motions import content, made_motion

from teleop.config.documents.document import DocumentError
from teleop.core.axes import Axis
from teleop.interchange import isolated
from teleop.interchange.companion import file_rate
from teleop.interchange.table import BY_NAME, Hints

RATE = Fraction(24)
KNOWN = Hints(RATE, "ZXY", None)
SCENE = 'xmlns="http://caliri.com/motion/scene"'


def scene(inner: str, name: str = "pan", units: str = "deg") -> bytes:
    """A move of one axis, whose second line has its first point and what comes after it."""
    axis = f'<axis name="{name}" units="{units}">\n<points x="0" y="1"/>{inner}</axis>'
    return f"<scene {SCENE}>{axis}</scene>".encode()


BOMB = '<!DOCTYPE a [<!ENTITY b "bb"><!ENTITY c "&b;&b;">]>'
OUTSIDE = '<!DOCTYPE a [<!ENTITY b SYSTEM "file:///etc/passwd">]>'

REFUSED = [
    ("chan", b"", KNOWN, "file: is empty"),
    ("chan", b"# a comment\n", KNOWN, "file:1:1: has no row of numbers"),
    ("chan", b"1 0 0 0 nan 0 0\n", KNOWN, "file:1:9: 'rx' must be a number, not 'nan'"),
    ("chan", b"1 0 0 0 0 0 0\n2 0 0 0 inf 0 0\n", KNOWN, "file:2:9: 'rx' must be a number, not 'inf'"),
    ("chan", b"1 0 0 0 0 0 0\n2 0 0 0 1e999 0 0\n", KNOWN, "file:2:9: tilt must be within 36000 degrees, not 1e999"),
    ("chan", b"1 0 0 0 0 0 0\n2 0 0 0 0 0\n", KNOWN, "file:2: has 6 values, and line 1 has 7"),
    ("chan", b"1 0 0 0 0 0\n", KNOWN, "file:1: has 6 columns, not 7 or 8: frame tx ty tz rx ry rz vfov"),
    ("chan", b"1 0 0 0 0 0 0\n1 0 0 0 0 0 0\n", KNOWN, "file:2:1: frame must be later than in the row before, not 1"),
    ("chan", b"1.5 0 0 0 0 0 0\n", KNOWN, "file:1:1: frame must be a whole number"),
    ("chan", b"1 0 0 0 0 0 0\n99999 0 0 0 0 0 0\n", KNOWN, "file:2:1: frame must be a whole number, at most 20000"),
    ("chan", b"1 0 0 0 0 0 0\n", Hints(RATE), "file: does not say its rotation order: give --rotation-order"),
    ("chan", b"1 0 0 0 0 0 0\n", Hints(None, "ZXY"), "file: does not say its frame rate: give --rate"),
    ("chan", b"1 0 0 0 0,5 0 0\n", KNOWN, "0,5: write 0.5"),
    ("chan", b"\x00\x01\x02" * 9, KNOWN, "file:1:1: is not text"),
    ("chan", b"1 0 0 0 0 0 0\n" * 30_000, KNOWN, "file:21000: is too long: at most 20000 frames"),
    ("csv", b"frame,pan\n1,0\n" + b"2," + b"1" * 9000, KNOWN, "file:3: is too long for a row"),
    ("csv", b"a,b\n1,2\n", KNOWN, "file: does not say which column is which axis: give --columns"),
    ("csv", b"pan,tilt\n1,2\n", Hints(None), "file: does not say its frame rate"),
    ("csv", b"time,pan\n0,2\n0,3\n", KNOWN, "file:3:1: time must be later than in the row before"),
    ("csv", b"pan,pan\n1,2\n", KNOWN, "file:2: has pan in two columns"),
    ("csv", b"time,focus\n0,2\n", KNOWN, "file:2:3: focus must be from -1 to 1, not 2"),
    ("raw", b"1 2\n", KNOWN, "file: does not say which column is which axis"),
    (
        "raw",
        b"1 2\n",
        Hints(RATE, None, ["pan"]),
        "file:1: has 2 columns, and --columns (or the file beside it) names 1",
    ),
    ("kuper", b"1 2\n", KNOWN, "file:1: must begin with the line `Axes = Pan, Tilt`"),
    ("kuper", b"Axes = Pan, Tilt\r\n1\r\n", KNOWN, "file:2: has 1 values, and line 1 names 2"),
    ("kuper", b"Axes = Pan\r\n", KNOWN, "file:1:1: has no row of numbers"),
    ("arcm", b"", KNOWN, "file: is empty"),
    ("arcm", b"<a", KNOWN, "file:1: is not XML: "),
    ("arcm", f"{BOMB}<scene {SCENE}>&c;</scene>".encode(), KNOWN, "file:1: has a document type (DTD)"),
    ("arcm", f"{OUTSIDE}<scene {SCENE}>&b;</scene>".encode(), KNOWN, "file:1: has a document type (DTD)"),
    ("arcm", f"{BOMB}<scene {SCENE}/>".encode("utf-16"), KNOWN, "file:1: has a document type (DTD)"),
    ("arcm", b"<scene/>", KNOWN, "file:1: is not a Dragonframe move"),
    ("arcm", f"<scene {SCENE}>{'<a>' * 50}".encode(), KNOWN, "file:1: is nested too deeply"),
    ("arcm", f"<scene {SCENE}/>".encode(), KNOWN, "file: has no axis called pan, tilt, roll or focus (it has none)"),
    ("arcm", scene('<points x="0" y="2"/>'), KNOWN, "file:1: pan: each point"),
    ("arcm", scene('<points x="1e999" y="2"/>'), KNOWN, "points x must be a"),
    ("arcm", scene('<points x="1" y="x"/>'), KNOWN, "points y must be a number"),
    ("arcm", scene('<points x="1e6" y="2"/>'), KNOWN, "file: is too long"),
    ("arcm", scene('<points x="1" y="2"/><controlPoints x="0.3" y="1"/>'), KNOWN, "pan has 1 control points, not 2"),
    ("arcm", scene("", units="rad"), KNOWN, "pan is in 'rad': its units must be deg"),
    ("blender", b"import bpy\nbpy.ops.wm.quit_blender()\n", KNOWN, "file: is not a script that teleop wrote"),
    ("blender", b"DATA = json.loads(r'''\n{\"a\": 1}\n''')", KNOWN, "file: its data was not written by teleop"),
    ("blender", b"DATA = json.loads(r'''\n{\"a\"\n''')", KNOWN, "file:1: its data was changed and is not JSON"),
    ("usd", b"#usda 1.0\ndef Xform", KNOWN, "file: is not USD"),
    ("usd", b"#usda 1.0\n", KNOWN, "file: has no camera"),
    (
        "usd",
        b'#usda 1.0\n(subLayers = [@/etc/passwd@])\ndef Camera "a" {}\n',
        KNOWN,
        "file: needs other files (/etc/passwd)",
    ),
    (
        "usd",
        b'#usda 1.0\ndef Camera "a" {}\ndef Camera "b" {}\n',
        KNOWN,
        "file: has 2 cameras: give --camera, one of /a, /b",
    ),
    (
        "usd",
        b'#usda 1.0\n(timeCodesPerSecond = 0.0001)\ndef Camera "a" {}\n',
        Hints(),
        "file: timeCodesPerSecond must be above 0, and 1000 at most",
    ),
    ("otio", b"{}", KNOWN, "file: has no timeline"),
    ("otio", b"{" * 100_000, KNOWN, "file: is not OpenTimelineIO"),
]


@pytest.mark.parametrize(("name", "raw", "hints", "error"), REFUSED)
def test_it_is_refused_in_one_line(name: str, raw: bytes, hints: Hints, error: str) -> None:
    with pytest.raises(DocumentError) as refused:
        BY_NAME[name].load().read(raw, "file", hints)
    assert error in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("text", ["1e-999999999", "1e999999999", "24/0", "1_0", "nan", "-24", "", None])
def test_a_rate_that_is_none_is_refused_at_once(text: object) -> None:
    """One with an exponent would take the memory of the computer as a fraction."""
    with pytest.raises(DocumentError, match="file: frame_rate must be frames a second"):
        file_rate(text, "file")


READ = [
    ("a byte order mark", b"\xef\xbb\xbfpan,tilt\n1,2\n3,4\n"),
    ("UTF-16", "pan,tilt\n1,2\n3,4\n".encode("utf-16")),
    ("mixed line ends", b"pan,tilt\r1,2\r\n3,4\n"),
    ("semicolons and a last one", b"pan;tilt;\n1;2;\n3;4;\n"),
    ("a last one in the rows alone", b"pan,tilt\n1,2,\n3,4,\n"),
    ("a last column that is empty in the first row", b"pan,tilt,actions\n1,2,\n3,4,record\n"),
    ("a last column that is empty in all rows", b"pan,tilt,actions\n1,2,\n3,4,\n"),
    ("names in capitals, and others", b"Tilt,x,PAN\n2,9,1\n4,9,3\n"),
    ("quotes", b'"pan","tilt"\n"1","2"\n"3","4"\n'),
    ("empty lines and comments", b"# made by hand\n\npan,tilt\n1,2\n\n3,4\n\n"),
]


@pytest.mark.parametrize("raw", [raw for _, raw in READ], ids=[what for what, _ in READ])
def test_what_is_meant_is_read(raw: bytes) -> None:
    found = BY_NAME["csv"].load().read(raw, "file", Hints(RATE))
    assert {axis.value: column.tolist() for axis, column in found.positions.items()} == {"pan": [1, 3], "tilt": [2, 4]}


def test_an_arc_move_of_another_program_is_read_on_its_curves() -> None:
    """As BlenderMoco writes it: prefixed, ease in and ease out, a dolly beside."""
    text = (
        '<scen:scene xmlns:scen="http://caliri.com/motion/scene" endframe="48"><scen:axis name="vTRACK" units="m">'
        '<scen:points y="0" x="1"/></scen:axis><scen:axis name="vPAN" units="deg"><scen:points y="0" x="1"/>'
        '<scen:points y="10" x="49"/><scen:controlPoints y="0" x="17"/><scen:controlPoints y="10" x="33"/></scen:axis>'
        "</scen:scene>"
    )
    found = BY_NAME["arcm"].load().read(text.encode(), "file", Hints(RATE))
    pan = found.positions[Axis.PAN]
    share = np.arange(49) / 48  # x is linear in t with handles at thirds, so y is 3t^2 - 2t^3
    assert pan == pytest.approx(10 * (3 * share**2 - 2 * share**3), abs=1e-9)
    assert found.remarks == ["axes that a head does not have: vTRACK"]


def test_handles_that_cross_make_no_frame_come_twice() -> None:
    inner = '<points x="24" y="5"/><controlPoints x="40" y="1"/><controlPoints x="-30" y="5"/>'
    pan = BY_NAME["arcm"].load().read(scene(inner), "file", Hints(RATE)).positions[Axis.PAN]
    assert np.isfinite(pan).all()
    assert (np.diff(pan) >= -1e-9).all()
    assert (pan[0], pan[-1]) == (1, 5)


def test_a_usd_file_whose_z_is_up_and_whose_camera_hangs_on_another_prim() -> None:
    text = """#usda 1.0
(
    upAxis = "Z"
    timeCodesPerSecond = 24
)
def Xform "head" {
    double xformOp:rotateZ.timeSamples = {1: 0, 3: -20}
    uniform token[] xformOpOrder = ["xformOp:rotateZ"]
    def Camera "lens" {
        double3 xformOp:translate = (0, 1, 0)
        double xformOp:rotateX = 100
        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateX"]
    }
}
"""
    found = BY_NAME["usd"].load().read(text.encode(), "file.usda", Hints())
    assert found.positions[Axis.PAN] == pytest.approx([0, 10, 20])
    assert found.positions[Axis.TILT] == pytest.approx([10, 10, 10])
    assert found.rate == 24
    assert found.remarks == ["positions: the camera travels, and a head only turns"]


def test_a_library_that_crashes_is_an_error_in_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(isolated.sys, "executable", "/bin/false")
    with pytest.raises(DocumentError, match=r"^file: cannot be read: the library that reads it gave up"):
        BY_NAME["otio"].load().read(content("otio", made_motion(3)), "file", Hints())


def test_a_library_that_never_ends_is_stopped(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    slow = tmp_path / "slow"
    slow.write_text("#!/bin/sh\nexec sleep 60\n")
    slow.chmod(0o755)
    monkeypatch.setattr(isolated, "LONGEST", 0.2)
    monkeypatch.setattr(isolated.sys, "executable", str(slow))
    with pytest.raises(DocumentError, match=r"^file: took longer than 0.2 s to read"):
        BY_NAME["otio"].load().read(content("otio", made_motion(3)), "file", Hints())


def test_what_a_crash_leaves_behind_goes_too(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """USD writes a report of a crash into TMPDIR, else into /var/tmp."""
    crash, kept = tmp_path / "crash", tmp_path / "kept"
    crash.write_text('#!/bin/sh\n: > "$TMPDIR/report"\nexit 134\n')
    crash.chmod(0o755)
    kept.mkdir()
    monkeypatch.setenv("TMPDIR", str(kept))
    monkeypatch.setattr(isolated.sys, "executable", str(crash))
    with pytest.raises(DocumentError, match="gave up"):
        BY_NAME["otio"].load().read(content("otio", made_motion(3)), "file", Hints())
    assert not list(kept.iterdir())
