"""Takes for the page: a list with what came of each, the report, the file, and keyframes made of it."""

from __future__ import annotations

import pytest
from console_bench import LOCKED, OPERATE, WATCHING, ConsoleBench, in_folder
from made_takes import at_rest, write_take

from teleop.core.axes import Axis, State

PATHS = [".hidden", "..%2fsecret", "a%5cb", "a%00b", "link", "dangling", "nope"]


@pytest.fixture
def folder(tmp_path):
    inside = tmp_path / "takes"
    inside.mkdir()
    write_take(inside / "still.mcap", {Axis.PAN: at_rest(5.0)}, 1.0, measured={Axis.PAN: lambda _: 5.25})
    write_take(tmp_path / "secret.mcap", {Axis.PAN: at_rest(5.0)}, 0.2)
    (inside / "link.mcap").symlink_to(tmp_path / "secret.mcap")
    (inside / "dangling.mcap").symlink_to(tmp_path / "none.mcap")
    return inside


@pytest.fixture
def bench(folder):
    with ConsoleBench(in_folder(folder)) as bench:
        yield bench


def test_a_list_has_length_result_and_peak_error(bench):
    (take,) = bench.get("/api/takes").json()["takes"]
    assert (take["name"], take["rig"], take["seconds"]) == ("still", "Bench", 1.0)
    assert (take["result"], take["ok"], take["peaks"]) == ("done", True, {"pan": 0.25})
    assert take["report"] == "/takes/still/report"


def test_a_take_that_failed_or_was_cut_says_so(bench, folder):
    motion = {Axis.PAN: at_rest(0.0)}
    write_take(folder / "failed.mcap", motion, 0.5, result="failed", reasons=["gimbal: silent"])
    write_take(folder / "cut.mcap", motion, 2.0, closed=False)
    (folder / "junk.mcap").write_bytes(b"junk")
    takes = {take["name"]: take for take in bench.get("/api/takes").json()["takes"]}
    assert (takes["failed"]["ok"], takes["failed"]["result"]) == (False, "failed: gimbal: silent")
    assert (takes["cut"]["ok"], takes["cut"]["result"]) == (False, "cut off")
    assert takes["junk"]["damaged"]
    assert str(folder) not in str(takes)


def test_one_take_has_the_errors_of_each_axis(bench):
    take = bench.get("/api/takes/still").json()
    assert take["axes"]["pan"]["peak"] == 0.25
    assert take["axes"]["pan"]["readings"] > 20


def test_a_changed_file_is_read_again(bench, folder):
    bench.get("/api/takes")
    (folder / "still.mcap").unlink()
    write_take(folder / "still.mcap", {Axis.PAN: at_rest(5.0)}, 1.5, measured={Axis.PAN: lambda _: 6.0})
    (take,) = bench.get("/api/takes").json()["takes"]
    assert (take["seconds"], take["peaks"]) == (1.5, {"pan": 1.0})


def test_the_report_is_a_page_in_a_sandbox(bench):
    answer = bench.get("/takes/still/report")
    assert answer.headers["content-type"].startswith("text/html")
    assert answer.headers["content-security-policy"].startswith("sandbox allow-scripts; default-src 'none'")
    assert "Bench" in answer.text


def test_the_file_is_downloaded_whole_and_never_shown(bench, folder):
    answer = bench.get("/takes/still/download")
    assert answer.content == (folder / "still.mcap").read_bytes()
    assert 'attachment; filename="still.mcap"' in answer.headers["content-disposition"]


def test_keys_of_a_take_become_a_new_move(bench, folder):
    def there(time):
        return State(min(time, 2.0) * 5.0, 5.0 if time < 2 else 0.0)

    write_take(folder / "way.mcap", {Axis.PAN: there}, 3.0)
    found = bench.post("/api/takes/way/keys", json={"tolerance": 1.0, "save": "again"}).json()
    assert found["ok"], found
    assert found["largest_errors"]["pan"]["error"] <= 1.0
    assert (folder / "again.yaml").read_text() == found["text"]
    assert found["content"]["keyframes"]
    assert bench.post("/api/takes/way/keys", json={"save": "again"}).status_code == 409


@pytest.mark.parametrize(
    "body", [{"tolerance": 0}, {"tolerance": "1"}, {"tolerance": True}, {"tolerance": 1e9}, {"save": 3}]
)
def test_keys_with_wrong_options_are_400(bench, body):
    assert bench.post("/api/takes/still/keys", json=body).status_code == 400


@pytest.mark.parametrize("name", PATHS)
@pytest.mark.parametrize("path", ["/api/takes/{}", "/takes/{}/report", "/takes/{}/download"])
def test_a_path_or_a_link_out_of_the_folder_is_no_take(bench, path, name):
    assert bench.get(path.format(name)).status_code == 404


def test_without_a_login_there_is_no_take_and_a_watcher_makes_no_keys(folder):
    with ConsoleBench(in_folder(folder, token=LOCKED.token, watch_token=LOCKED.watch_token)) as bench:
        for path in ("/api/takes", "/api/takes/still", "/takes/still/report", "/takes/still/download"):
            assert bench.get(path).status_code == 401
            assert bench.get(path, headers=WATCHING).status_code == 200
        assert bench.post("/api/takes/still/keys", json={}, headers=WATCHING).status_code == 403
        assert bench.post("/api/takes/still/keys", json={"save": "../x"}, headers=OPERATE).status_code == 400
