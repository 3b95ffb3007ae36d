"""Who gets in: tokens, cookies, Origin and Host, and how often one may try."""

from __future__ import annotations

import pytest
from console_bench import BASE, LOCKED, OPERATE, TOKEN, WATCH, ConsoleBench
from starlette.testclient import WebSocketDenialResponse
from starlette.websockets import WebSocketDisconnect

from teleop.console.gate import HEADERS, client_address
from teleop.console.login import COOKIE_SECONDS, Logins
from teleop.console.rate_limit import RateLimit, client_key
from teleop.console.settings import ConsoleSettings

PATHS = ["/api", "/api/state", "/vendor/uplot/uPlot.iife.min.js"]


@pytest.fixture
def locked():
    with ConsoleBench(LOCKED) as bench:
        yield bench


@pytest.fixture
def bench():
    with ConsoleBench() as bench:
        yield bench


@pytest.mark.parametrize("path", PATHS)
def test_without_the_token_nothing_is_served(locked, path):
    answer = locked.get(path)
    assert answer.status_code == 401
    assert set(answer.json()) == {"error"}


@pytest.mark.parametrize("path", ["/api/command", "/api/stop"])
def test_without_the_token_nothing_is_obeyed(locked, path):
    assert locked.post(path, json={"do": "stop"}).status_code == 401
    assert locked.door.commands == []


@pytest.mark.parametrize("path", ["/", "/login"])
def test_without_the_token_there_is_the_login_page_whole_in_one_file(locked, path):
    answer = locked.get(path)
    assert answer.status_code == 200
    assert "Log in" in answer.text
    assert "src=" not in answer.text
    assert "sha256-" in answer.headers["content-security-policy"]
    assert "unsafe" not in answer.headers["content-security-policy"]


@pytest.mark.parametrize(("token", "role"), [(TOKEN, "operate"), (WATCH, "watch")])
def test_a_token_becomes_a_cookie_that_scripts_of_a_page_cannot_read(locked, token, role):
    answer = locked.post("/api/login", json={"token": token})
    assert answer.json() == {"ok": True, "role": role}
    attributes = [part.strip() for part in answer.headers["set-cookie"].split(";")]
    assert {"HttpOnly", "SameSite=Strict", "Path=/"} <= set(attributes)
    assert token not in answer.headers["set-cookie"]
    assert locked.get("/api/state").status_code == 200
    status = locked.post("/api/command", json={"do": "goto", "axes": {"pan": 1}}).status_code
    assert status == (200 if role == "operate" else 403)


def test_with_tls_the_cookie_is_secure():
    secure = ConsoleSettings(token=TOKEN, watch_token=WATCH, certificate="c.pem", key="k.pem")
    assert "; Secure" in Logins(secure).cookie("watch")


@pytest.mark.parametrize("token", ["", "wrong", TOKEN + "x", TOKEN[:-1], "\u00e9", "x" * 1000])
def test_a_wrong_token_is_401(locked, token):
    assert locked.post("/api/login", json={"token": token}).status_code == 401
    bearer = {"authorization": f"Bearer {token}".encode()}
    assert locked.get("/api/state", headers=bearer).status_code == 401


@pytest.mark.parametrize("token", [None, 3, [TOKEN], {"a": 1}])
def test_a_token_of_another_kind_is_400(locked, token):
    assert locked.post("/api/login", json={"token": token}).status_code == 400


def test_the_bearer_counts_and_not_the_cookie(locked):
    locked.post("/api/login", json={"token": TOKEN})
    assert locked.get("/api/state", headers={"authorization": "Bearer wrong"}).status_code == 401


def guess(bench, count=20):
    return [bench.post("/api/login", json={"token": f"guess {i}"}).status_code for i in range(count)]


def test_many_wrong_tokens_are_counted_and_each_then_costs_a_connection(locked):
    assert guess(locked) == [401] * 10 + [429] * 10
    answer = locked.get("/api/state", headers={"authorization": "Bearer wrong"})
    assert answer.status_code == 429
    assert (answer.headers["retry-after"], answer.headers["connection"]) == ("10", "close")
    locked.now += 10
    assert guess(locked, 2) == [401, 429]


def test_who_is_logged_in_is_not_refused_for_what_others_at_the_same_address_get_wrong(locked):
    locked.post("/api/login", json={"token": WATCH})
    cookie = dict(locked.cookies)
    locked.cookies.clear()
    guess(locked)
    while locked.get("/api/state").status_code != 429:
        pass  # until this address has asked too often, too
    for headers in (OPERATE, {"cookie": "; ".join(f"{name}={value}" for name, value in cookie.items())}):
        assert locked.post("/api/stop", headers=headers).status_code == 200
        assert locked.get("/api/state", headers=headers).status_code == 200
        with locked.page(headers) as page:
            assert page.receive_json()["type"] == "hello"
    assert locked.post("/api/login", json={"token": TOKEN}).status_code == 200


def test_stop_is_never_too_often_for_who_is_logged_in(locked):
    while locked.get("/api/state", headers=OPERATE).status_code != 429:
        pass
    assert locked.post("/api/stop", headers=OPERATE).status_code == 200
    assert locked.post("/api/stop").status_code == 401


def test_a_cookie_is_good_for_its_tokens_and_its_time_only():
    now = [1e9]
    logins = Logins(LOCKED, lambda: now[0])
    value = logins.cookie("watch").partition(";")[0].partition("=")[2]
    assert logins.role_of_cookie(value) == "watch"
    assert Logins(LOCKED, lambda: now[0]).role_of_cookie(value) == "watch"  # of a gateway that was started again
    assert Logins(ConsoleSettings(token="other", watch_token=WATCH)).role_of_cookie(value) is None
    now[0] += COOKIE_SECONDS + 1
    assert logins.role_of_cookie(value) is None


@pytest.mark.parametrize(
    "forge", [lambda v: v.replace("watch", "operate"), lambda v: v[:-1], lambda v: "", lambda v: "é"]
)
def test_a_forged_cookie_is_worthless(forge):
    logins = Logins(LOCKED)
    value = logins.cookie("watch").partition(";")[0].partition("=")[2]
    assert logins.role_of_cookie(forge(value)) is None


ORIGINS = [
    *(
        "http://evil.example",
        "http://evil.example:8470",
        "null",
        "",
        "file://",
        "127.0.0.1:8470",
        "chrome-extension://a",
    ),
    *(
        "http://127.0.0.1:9999",
        "http://127.0.0.1",
        "https://127.0.0.1:8470",
        "http://localhost:8470",
        "http://[::1]:8470",
    ),
    *(
        "http://127.0.0.1.:8470",
        "http://127.0.0.1:8470/",
        "http://127.0.0.1:8470.evil.example",
        "http://a.127.0.0.1:8470",
    ),
    *(
        "http://127.1:8470",
        "http://2130706433:8470",
        "http://x@127.0.0.1:8470",
        "http://127.0.0.1:8470 http://127.0.0.1:8470",
    ),
]
HOSTS = [
    *("evil.example", "evil.example:8470", "127.0.0.1", "127.0.0.1:80", "10.0.0.1:8470", "", "127.0.0.1.:8470"),
    *(
        "localhost.:8470",
        "a.localhost:8470",
        "localhost.evil.example:8470",
        "127.1:8470",
        "2130706433:8470",
        "::1:8470",
    ),
    *(
        "[::1]",
        "[::2]:8470",
        "[::ffff:7f00:1]:8470",
        "x@127.0.0.1:8470",
        "127.0.0.1:8470, evil.example",
        "0.0.0.0:8470",
    ),
]


@pytest.mark.parametrize("origin", ORIGINS)
@pytest.mark.parametrize(("method", "path"), [("POST", "/api/stop"), ("GET", "/api/state"), ("GET", "/")])
def test_a_foreign_origin_is_refused_on_loopback_too(bench, origin, method, path):
    assert bench.request(method, path, headers={"origin": origin}).status_code == 403
    assert bench.door.commands == []


def test_the_consoles_own_origin_is_welcome(bench):
    assert bench.post("/api/stop", headers={"origin": BASE}).status_code == 200


@pytest.mark.parametrize("host", HOSTS)
def test_a_foreign_host_is_refused(bench, host):
    for path in ("/", "/api/state", "/login"):
        assert bench.get(path, headers={"host": host}).status_code == 403


@pytest.mark.parametrize("headers", [*({"origin": each} for each in ORIGINS), *({"host": each} for each in HOSTS)])
def test_a_websocket_of_another_origin_or_host_is_refused_on_loopback_too(bench, headers):
    """DNS rebinding among them: a name that points here has an Origin that agrees with its Host."""
    if "host" in headers:
        headers |= {"origin": f"http://{headers['host']}"}
    with pytest.raises(WebSocketDenialResponse) as refused, bench.page(headers):
        pass
    assert refused.value.status_code == 403
    assert bench.door.commands == []


def test_a_websocket_of_this_consoles_own_page_is_welcome(bench):
    with bench.page({"origin": BASE}) as page:
        assert page.receive_json()["type"] == "hello"


@pytest.mark.parametrize("host", ["localhost:8470", "127.0.0.1:8470", "[::1]:8470", "LOCALHOST:8470"])
def test_the_names_of_this_computer_are_welcome(bench, host):
    assert bench.get("/api/state", headers={"host": host}).status_code == 200


def test_a_wildcard_address_takes_the_address_of_the_connection_only():
    everywhere = ConsoleSettings(host="0.0.0.0", token=TOKEN, watch_token=WATCH)
    with ConsoleBench(everywhere, base_url="http://192.168.1.7:8470") as bench:
        assert bench.get("/api/state", headers=OPERATE).status_code == 200
        assert bench.get("/api/state", headers={**OPERATE, "host": "192.168.1.8:8470"}).status_code == 403


def test_an_ipv4_client_of_a_socket_for_both_kinds_is_known_by_its_address():
    everywhere = ConsoleSettings(host="::", token=TOKEN, watch_token=WATCH)
    client = {"client": ("::ffff:192.168.1.9", 1), "base_url": "http://[::ffff:192.168.1.7]:8470"}
    with ConsoleBench(everywhere, **client) as bench:
        assert bench.get("/api/state", headers={**OPERATE, "host": "192.168.1.7:8470"}).status_code == 200
    assert client_address({"client": ("::ffff:192.168.1.9", 1)}) == "192.168.1.9"


@pytest.mark.parametrize("site", ["cross-site", "same-site"])
def test_what_another_sites_page_asks_for_is_refused(bench, site):
    assert bench.get("/api/state", headers={"sec-fetch-site": site}).status_code == 403
    followed = {"sec-fetch-site": site, "sec-fetch-mode": "navigate", "sec-fetch-dest": "document"}
    assert bench.get("/login", headers=followed).status_code == 200
    assert bench.get("/login", headers={**followed, "sec-fetch-dest": "iframe"}).status_code == 403


@pytest.mark.parametrize(
    ("headers", "status"),
    [({}, 401), ({"authorization": "Bearer wrong"}, 401), ({**OPERATE, "origin": "http://evil.example"}, 403)],
)
def test_a_websocket_is_refused_likewise(locked, headers, status):
    with pytest.raises(WebSocketDenialResponse) as refused, locked.page(headers):
        pass
    assert refused.value.status_code == status
    assert isinstance(refused.value, WebSocketDisconnect)


@pytest.mark.parametrize("path", ["/login", "/api/state", "/nope", "/vendor/uplot/uPlot.min.css"])
def test_every_answer_has_the_security_headers(bench, path):
    answer = bench.get(path)
    policy = {} if path == "/login" else {"content-security-policy": HEADERS["content-security-policy"]}
    assert {**HEADERS, **answer.headers, **policy} == {**answer.headers, **policy}
    assert "frame-ancestors 'none'" in answer.headers["content-security-policy"]
    assert "default-src 'none'" in answer.headers["content-security-policy"]
    assert "server" not in answer.headers


def test_a_bucket_fills_with_time_and_clients_are_forgotten_in_their_order():
    now = [0.0]
    limit = RateLimit(1, 2, lambda: now[0])
    assert [limit.take("a") for _ in range(3)] == [True, True, False]
    now[0] = 1
    assert limit.take("a")
    for i in range(2000):
        limit.take(f"10.0.{i // 250}.{i % 250}")
    assert len(limit._buckets) == 1000


def test_an_ipv6_network_is_one_client():
    assert client_key("2001:db8::1") == client_key("2001:db8::2") != client_key("2001:db9::1")
    assert client_key("testclient") == "testclient"
