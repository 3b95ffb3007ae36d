"""Moves for the page: what is listed, read, saved and planned; names that are paths, and files out of the folder."""

from __future__ import annotations

import pytest
from console_bench import LOCKED, OPERATE, WATCHING, ConsoleBench, in_folder

from teleop.config.documents.yaml_loader import parse_document
from teleop.config.profile import load_profile
from teleop.console.planning import plan_text
from teleop.console.settings import planned_for

MOVE = """\
# Across the room.
title: Across   # as on the slate
keyframes:
  - {at: 0, pan: 0}    # the door
  - {at: 4, pan: 20}   # the window
"""
HASTY = {"keyframes": [{"at": 0, "pan": 0}, {"at": 0.2, "pan": 90}, {"at": 9, "pan": 0}]}


@pytest.fixture
def folder(tmp_path):
    inside = tmp_path / "moves"
    inside.mkdir()
    (inside / "across.yaml").write_text(MOVE)
    (tmp_path / "secret.yaml").write_text(MOVE.replace("Across", "Secret"))
    return inside


@pytest.fixture
def bench(folder):
    with ConsoleBench(in_folder(folder)) as bench:
        yield bench


def test_moves_of_the_folder_and_shipped_ones_are_listed(bench, folder):
    (folder / "rig.yaml").write_text("links: {}\nsinks: []\n")
    (folder / "broken.yaml").write_text("{")
    (folder / "lapse.yml").write_text("timelapse: {frames: 2, interval: 5s}\nkeyframes: [{at: 0, pan: 0}]\n")
    moves = {move["name"]: move for move in bench.get("/api/moves").json()["moves"]}
    assert moves["across"] == {"name": "across", "shipped": False, "title": "Across", "kind": "move", "problem": ""}
    assert moves["reveal"]["shipped"]
    assert moves["lapse"]["kind"] == "timelapse"
    assert moves["broken"]["problem"]
    assert "rig" not in moves


def test_a_file_of_the_folder_hides_the_shipped_one_of_its_name(bench, folder):
    (folder / "reveal.yaml").write_text(MOVE)
    (found,) = [move for move in bench.get("/api/moves").json()["moves"] if move["name"] == "reveal"]
    assert not found["shipped"]
    assert bench.get("/api/moves/reveal").json()["text"] == MOVE


def test_a_move_is_read_as_text_and_as_values(bench):
    move = bench.get("/api/moves/across").json()
    assert move["text"] == MOVE
    assert move["content"] == parse_document(MOVE, "m").data
    assert bench.get("/api/moves/nudge").json()["shipped"]
    assert bench.get("/api/moves/nope").status_code == 404


def test_saving_values_keeps_the_comments(bench, folder):
    content = bench.get("/api/moves/across").json()["content"]
    content["keyframes"][1]["pan"] = 25.5
    content["keyframes"].insert(1, {"at": 2, "pan": 9})
    answer = bench.put("/api/moves/across", json={"content": content})
    assert answer.status_code == 200
    expected = MOVE.replace("pan: 20}", "pan: 25.5}").replace("# the door\n", "# the door\n  - {at: 2, pan: 9}\n")
    assert (folder / "across.yaml").read_text() == expected == answer.json()["text"]


def test_a_shipped_move_is_saved_into_the_folder_with_its_comments(bench, folder):
    content = bench.get("/api/moves/reveal").json()["content"]
    content["title"] = "Mine"
    assert bench.put("/api/moves/reveal", json={"content": content}).status_code == 200
    assert (folder / "reveal.yaml").read_text().startswith("# A slow reveal")
    assert not bench.get("/api/moves/reveal").json()["shipped"]


def test_a_new_move_is_a_new_file(bench, folder):
    content = {"title": "New", "keyframes": [{"at": 0, "pan": 0}, {"at": "4s", "pan": 20}]}
    assert bench.put("/api/moves/new one", json={"content": content}).status_code == 200
    assert parse_document((folder / "new one.yaml").read_text(), "m").data == content
    assert bench.put("/api/moves/text", json={"text": MOVE}).status_code == 200
    assert (folder / "text.yaml").read_text() == MOVE


@pytest.mark.parametrize(
    ("body", "line", "column"),
    [
        ({"text": "keyframes: [{at: 0, pan: 0}, {at: 1, pan: 900}]\n"}, 1, 43),
        ({"text": "keyframes:\n  - {at: 0, pan: 0\n"}, 3, 1),
        ({"text": "keyframes:\n  - {at: 0, nose: 0}\n"}, 2, 5),
        ({"text": "- 1"}, 1, 1),
    ],
)
def test_what_does_not_parse_or_plan_is_refused_with_its_place_and_not_written(bench, folder, body, line, column):
    answer = bench.put("/api/moves/across", json=body)
    assert answer.status_code == 422
    problem = answer.json()["problems"][0]
    assert (problem["line"], problem["column"]) == (line, column)
    assert answer.json()["error"]
    assert (folder / "across.yaml").read_text() == MOVE


def test_what_someone_else_has_saved_since_is_not_overwritten(bench, folder):
    version = bench.get("/api/moves/across").json()["version"]
    (folder / "across.yaml").write_text(MOVE.replace("20", "21"))
    assert bench.put("/api/moves/across", json={"text": MOVE, "version": version}).status_code == 409
    assert "21" in (folder / "across.yaml").read_text()


@pytest.mark.parametrize(
    "name",
    [".hidden", "..%2fsecret", "%2e%2e%2fsecret", "a%2fb", "a%5cb", "~", "a%00b", "-x", "a%0ab", "x" * 200],
)
def test_a_name_is_never_a_path(bench, folder, name):
    before = sorted(folder.parent.rglob("*"))
    assert bench.get(f"/api/moves/{name}").status_code == 404
    assert bench.put(f"/api/moves/{name}", json={"text": MOVE}).status_code in (400, 404, 405)
    assert sorted(folder.parent.rglob("*")) == before


def test_a_file_that_is_no_move_is_neither_read_nor_written(bench, folder):
    text = "name: My rig\nlinks: {gimbal: 'sim:'}\naxes: {pan: {min: -1, max: 1}}\nsinks: []\n"
    (folder / "rig.yaml").write_text(text)
    assert bench.get("/api/moves/rig").status_code == 404
    answer = bench.put("/api/moves/rig", json={"text": "keyframes: [{at: 0, pan: 0}, {at: 4, pan: 1}]\n"})
    assert answer.status_code == 409
    assert "no move: choose another one" in answer.json()["error"]
    assert (folder / "rig.yaml").read_text() == text


def test_a_link_out_of_the_folder_is_neither_read_nor_written(bench, folder):
    (folder / "link.yaml").symlink_to(folder.parent / "secret.yaml")
    (folder / "dangling.yaml").symlink_to(folder.parent / "new.yaml")
    (folder / "circle.yaml").symlink_to(folder / "circle.yaml")
    names = {move["name"] for move in bench.get("/api/moves").json()["moves"]}
    assert not {"link", "dangling", "circle"} & names
    for name in ("link", "dangling", "circle"):
        assert bench.get(f"/api/moves/{name}").status_code == 404
        assert bench.put(f"/api/moves/{name}", json={"text": MOVE}).status_code == 400
    assert "Secret" in (folder.parent / "secret.yaml").read_text()
    assert not (folder.parent / "new.yaml").exists()


FOREIGN = ["../secret.yaml", "/etc/passwd", "~/x.yaml", "link.yaml", "./across.yaml", "sub/x.yaml"]


@pytest.mark.parametrize("name", FOREIGN)
@pytest.mark.parametrize("shape", ["include", "source"])
def test_what_a_move_names_is_in_the_folder_too(bench, folder, name, shape):
    (folder / "link.yaml").symlink_to(folder.parent / "secret.yaml")
    named = {
        "include": {"include": [{"move": name, "at": 0}]},
        "source": {"source": {"file": name, "columns": {"pan": 1}, "fps": 24}},
    }
    for answer in (
        bench.post("/api/plan", json={"content": named[shape]}).json(),
        bench.put("/api/moves/new", json={"content": named[shape]}).json(),
    ):
        assert "no such file in the folder of moves" in answer["error"]
        assert "Secret" not in str(answer)
    assert not (folder / "new.yaml").exists()


def test_files_of_the_folder_and_shipped_moves_can_be_included(bench, folder):
    (folder / "pans.csv").write_text("\n".join(str(frame / 100) for frame in range(48)) + "\n")
    for content in (
        {"include": [{"move": "across.yaml", "at": 1}]},
        {"include": [{"move": "nudge", "at": 1}]},
        {"source": {"file": "pans.csv", "columns": {"pan": 1}, "fps": 24}},
    ):
        assert bench.post("/api/plan", json={"content": content}).json()["ok"] is True


def test_a_plan_is_the_planners_own_curve(bench):
    plan = bench.post("/api/plan", json={"move": "across"}).json()
    assert (plan["ok"], plan["title"], plan["duration"]) == (True, "Across", 4.0)
    pan = plan["axes"]["pan"]
    assert (pan["times"][0], pan["times"][-1]) == (0, 4)
    assert (pan["positions"][0], pan["positions"][-1], pan["unit"]) == (0, 20, "deg")
    assert max(map(abs, pan["velocities"])) == pytest.approx(pan["peak_velocity"], rel=0.01)
    assert plan["keys"] == [
        {"number": 1, "at": 0.0, "hold": 0.0, "axes": {"pan": 0.0}},
        {"number": 2, "at": 4.0, "hold": 0.0, "axes": {"pan": 20.0}},
    ]
    assert plan["max_speed"] > 1


def test_a_plan_of_a_timelapse_says_how_long_the_shoot_takes(bench):
    shoot = bench.post("/api/plan", json={"move": "day-to-night"}).json()["shoot"]
    assert (shoot["frames"], shoot["clip_s"]) == (744, 31.0)
    assert (shoot["intervals"][0], shoot["intervals"][-1]) == (6.5, 14.0)
    assert shoot["seconds"] == pytest.approx(744 * (6.5 + 14) / 2, rel=0.01)
    assert bench.post("/api/plan", json={"move": "across"}).json()["shoot"] is None


def test_what_is_infeasible_names_its_segment_and_the_shortest_time(bench):
    plan = bench.post("/api/plan", json={"content": HASTY}).json()
    assert plan["ok"] is False
    (segment,) = plan["segments"]
    assert (segment["axis"], segment["first"], segment["last"], segment["seconds"]) == ("pan", 1, 2, 0.2)
    stretched = {"keyframes": [dict(key) for key in HASTY["keyframes"]]}
    stretched["keyframes"][1]["at"] = segment["shortest"] + 0.01
    assert bench.post("/api/plan", json={"content": stretched}).json()["ok"] is True


def test_a_plan_is_answered_over_the_websocket_and_as_a_command_too(bench):
    with bench.page() as socket:
        socket.send_json({"id": 1, "do": "plan", "content": HASTY})
        while (message := socket.receive_json())["type"] != "answer":
            pass
    assert (message["ok"], message["segments"][0]["first"]) == (False, 1)
    assert bench.command("plan", move="across").json()["duration"] == 4


@pytest.mark.parametrize(
    "body",
    [{}, {"move": 3}, {"text": 3}, {"content": []}, {"content": {}}, {"move": "a", "text": "b"}, {"move": "../x"}],
)
def test_a_plan_of_nothing_is_refused(bench, body):
    assert bench.post("/api/plan", json=body).status_code in (400, 404)


def test_a_move_of_10_mb_is_413(bench):
    assert bench.put("/api/moves/across", json={"text": "#" * 10_000_000}).status_code == 413


def test_watchers_see_and_do_not_save(folder):
    with ConsoleBench(in_folder(folder, token=LOCKED.token, watch_token=LOCKED.watch_token)) as bench:
        assert bench.get("/api/moves/across", headers=WATCHING).status_code == 200
        assert bench.post("/api/plan", json={"move": "across"}, headers=WATCHING).json()["ok"]
        assert bench.put("/api/moves/across", json={"text": MOVE}, headers=WATCHING).status_code == 403
        assert bench.put("/api/moves/across", json={"text": MOVE}, headers=OPERATE).status_code == 200


def test_a_plan_keeps_the_limits_that_the_run_leaves_of_the_rig_whatever_its_file_says_now(tmp_path):
    file = tmp_path / "rig.yaml"
    file.write_text(RIG)
    kept = planned_for(load_profile(str(file)).gentler(0.25))
    file.write_text(RIG.replace("velocity: 60", "velocity: 90"))
    text = "keyframes: [{at: 0, pan: 0}, {at: 2s, pan: 40}]\n"
    assert plan_text(text, "a", str(tmp_path), str(file))["axes"]["pan"]["max_velocity"] == 90
    refused = plan_text(text, "a", str(tmp_path), kept)
    assert not refused["ok"]
    assert refused["segments"][0]["axis"] == "pan"
    slow = plan_text(text.replace("2s", "20s"), "a", str(tmp_path), kept)
    assert slow["axes"]["pan"]["max_velocity"] == 15


RIG = """
name: Bench
links: {gimbal: "sim:"}
axes: {pan: {min: -180, max: 180, velocity: 60, acceleration: 240, jerk: 2400}}
sinks: [{type: gimbal, link: gimbal, mode: position, rate: 50}]
"""
