"""A take that was never closed becomes a sound one; whatever is wrong with it, the original is left alone."""

from __future__ import annotations

import json
import os
import signal
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from command import running, teleop
from hypothesis import given, settings
from hypothesis import strategies as st
from made_takes import write_take
from mcap.reader import make_reader
from waiting import wait_until

from teleop.config.documents.document import DocumentError
from teleop.core.axes import Axis, State
from teleop.core.events import Action
from teleop.recording.reader import read_take
from teleop.recording.recover import is_sound, recover
from teleop.recording.summary import summarize, summarize_index


def swing(time: float) -> State:
    return State(20 * float(np.sin(time)), 20 * float(np.cos(time)), -20 * float(np.sin(time)))


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("takes") / "whole.mcap"
    measured = {Axis.PAN: lambda time: swing(time).position}
    return write_take(path, {Axis.PAN: swing}, 4.0, measured=measured, acts={0: [Action.RECORD]}, reasons=["why not"])


def saved(path: Path, target: Path) -> int:
    with target.open("wb") as stream:
        return recover(path, stream).messages


def test_a_process_killed_in_the_middle_of_a_run_loses_less_than_a_second(tmp_path: Path) -> None:
    take = tmp_path / "killed.mcap"
    with running("play", "reveal", "--take", str(take)) as process:
        wait_until(lambda: take.exists() and take.stat().st_size > 20_000, "a recording", 20)
        os.kill(process.pid, signal.SIGKILL)
        assert process.wait() == -signal.SIGKILL
    before = take.read_bytes()
    assert not is_sound(take)
    done = teleop("take", "recover", take.name, "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    said = json.loads(done.stdout)
    new = tmp_path / "killed-recovered.mcap"
    assert said["written"] == new.name
    assert take.read_bytes() == before
    with new.open("rb") as stream:
        reader = make_reader(stream)
        summary = reader.get_summary()
        assert summary is not None
        assert summary.statistics is not None
        assert summary.statistics.message_count == said["messages"]
        ticks = sum(channel.topic == "/motion" for _, channel, _ in reader.iter_messages())
    assert ticks == said["ticks"] > 50
    assert summarize(new).remark == ""
    assert (summarize_index(new).seconds, read_take(new).cut) == (pytest.approx(said["seconds"], abs=0.01), True)
    again = teleop("play", new.name, "--fast", "--json", cwd=tmp_path)
    assert again.returncode == 0, again.stderr
    assert "the recording was cut off at" in again.stderr


def test_what_was_whole_is_copied_to_the_byte(whole: Path, tmp_path: Path) -> None:
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(whole.read_bytes()[:-900])
    assert not is_sound(cut)
    count = saved(cut, tmp_path / "new.mcap")
    with whole.open("rb") as one, (tmp_path / "new.mcap").open("rb") as two:
        before, after = ([*make_reader(stream).iter_messages(log_time_order=False)] for stream in (one, two))
    assert after == before[: len(after)]
    assert len(after) == count > 300


def test_of_a_run_whose_index_alone_is_missing_the_end_is_known(whole: Path, tmp_path: Path) -> None:
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(whole.read_bytes()[:-4])
    saved(cut, tmp_path / "new.mcap")
    assert read_take(cut).remark != ""
    assert read_take(tmp_path / "new.mcap").ended == "done: why not"
    assert is_sound(tmp_path / "new.mcap")


@settings(max_examples=150, deadline=None)
@given(st.data())
def test_a_file_cut_anywhere_or_damaged_anywhere_is_saved_or_refused_and_never_changed(
    whole: Path, tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    content = bytearray(whole.read_bytes())
    if data.draw(st.booleans()):
        content[data.draw(st.integers(0, len(content) - 1))] ^= data.draw(st.integers(1, 255))
    content = content[: data.draw(st.integers(0, len(content)))]
    place = tmp_path_factory.getbasetemp()
    cut, new = place / "anywhere.mcap", place / "anywhere-new.mcap"
    cut.write_bytes(content)
    for look in (summarize_index, summarize, read_take):
        with suppress(DocumentError):
            assert look(cut).about is not None
    with suppress(DocumentError):
        count = saved(cut, new)
        with new.open("rb") as stream:
            assert sum(1 for _ in make_reader(stream).iter_messages()) == count
        assert is_sound(new)
        left, full = read_take(new), read_take(whole)
        kept = full.times[: len(left.times)]
        assert np.diff(left.times) == pytest.approx(np.diff(kept), abs=1e-6)  # when it began has no checksum
        for axis in left.axes:
            np.testing.assert_array_equal(left.motion[axis], full.motion[axis][:, : len(left.times)])
    assert cut.read_bytes() == content


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["whole.mcap"], ""),
        (["cut.mcap", "-o", "cut.mcap"], "teleop: -o cut.mcap: is the take itself; choose another file"),
        (["cut.mcap", "-o", "there.mcap"], "teleop: -o there.mcap: already exists; give --overwrite to replace it"),
        (["cut.mcap", "-o", "new.txt"], "teleop: -o new.txt: its ending must be .mcap"),
        (["text.mcap"], "text.mcap: not a take (.mcap), or cut off before anything was recorded"),
        (["begun.mcap"], "begun.mcap: nothing to recover: it was cut off before its first second was written"),
        (["nothing.mcap"], "nothing.mcap: cannot be read: No such file or directory"),
    ],
)
def test_what_cannot_be_recovered_is_said_in_one_line(
    whole: Path, tmp_path: Path, arguments: list[str], said: str
) -> None:
    content = whole.read_bytes()
    files = {
        "whole": content,
        "cut": content[:-900],
        "there": b"mine",
        "text": b"keyframes: []\n",
        "begun": content[:700],
    }
    for name, data in files.items():
        (tmp_path / f"{name}.mcap").write_bytes(data)
    done = teleop("take", "recover", *arguments, cwd=tmp_path)
    assert done.stderr.strip() == said
    assert done.returncode == (2 if said else 0)
    assert (tmp_path / "there.mcap").read_bytes() == b"mine"
    assert len(list(tmp_path.iterdir())) == len(files)
