"""The server from the outside: the documented messages, and whoever means no good."""

from __future__ import annotations

import json
import re
import warnings
from pathlib import Path

import pytest
from starlette.websockets import WebSocketDisconnect

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    from starlette import testclient

from nao_sim.live import server
from nao_sim.live.hub import Hub, Limits
from nao_sim.live.pool import Here
from nao_sim.live.protocol import LARGEST, pack, parse
from nao_sim.live.security import Allowance, Gate
from nao_sim.live.server import application
from tests.live.senders import as_text, frames

DOCS = Path(__file__).resolve().parents[2] / "docs" / "live.md"
EXAMPLES = [json.loads(block) for block in re.findall(r"```json\n(.*?)\n```", DOCS.read_text(encoding="utf-8"), re.S)]
SAID = [each for each in EXAMPLES if each["type"] in {"hello", "frame", "config", "pause", "record", "replay",
        "download", "reset", "ping"}]  # fmt: skip
HEARD = {each["type"]: each for each in EXAMPLES if each not in SAID}
TOKEN = "a-token-that-is-long"
URL = "ws://localhost/live"


@pytest.fixture(scope="module")
def open_server(world):
    """A server on loopback."""
    hub = Hub(Here(world), world.robot, Limits(clients=12, robots=4))
    with testclient.TestClient(application(hub, Gate()), base_url="http://localhost") as client:
        yield client


@pytest.fixture(scope="module")
def guarded_server(world):
    """A server that is open to others."""
    hub = Hub(Here(world), world.robot)
    gate = Gate(loopback=False, token=TOKEN)
    with testclient.TestClient(application(hub, gate), base_url="http://robot.lab") as client:
        yield client


def _next(socket, *kinds: str) -> dict:
    """The next message of some kind."""
    for _ in range(2000):
        message = json.loads(socket.receive_text())
        if message["type"] in kinds:
            return message
    raise AssertionError(f"no {kinds}")


def _refused(client, first: str | bytes, url: str = URL, **how) -> dict:
    """The error of a connection that is ended, once it has."""
    with client.websocket_connect(url, **how) as socket:
        socket.send_bytes(first) if isinstance(first, bytes) else socket.send_text(first)
        error = _next(socket, "error")
        with pytest.raises(WebSocketDisconnect) as end:
            socket.receive_text()
    assert error["fatal"]
    assert end.value.code == 1008
    return error


def _hello(**fields: object) -> str:
    return json.dumps({"type": "hello", **fields})


def test_every_documented_message_is_understood_and_every_documented_answer_has_the_documented_keys(open_server):
    asked = {each["type"]: each for each in SAID}
    heard: dict[str, dict] = {}
    with open_server.websocket_connect(URL) as socket:
        socket.send_text(json.dumps(asked.pop("hello")))
        heard["welcome"] = _next(socket, "welcome")
        socket.send_text(json.dumps(asked.pop("frame")))
        heard["error"] = _next(socket, "error")
        assert heard["error"]["code"] == "wrong_size"
        for kind in ("record", "pause", "config", "ping"):
            socket.send_text(json.dumps(asked.pop(kind)))
            heard |= {answer["type"]: answer for answer in [_next(socket, "done", "pong")]}
        for place, frame in enumerate(frames(12)):
            socket.send_bytes(pack(frame)) if place % 2 else socket.send_text(as_text(frame))
        heard["understood"] = _next(socket, "understood")
        heard["state"] = _next(socket, "state")
        for kind, answer in (("download", "recording"), ("replay", "done"), ("reset", "done")):
            socket.send_text(json.dumps(asked.pop(kind)))
            heard[answer] = _next(socket, answer, "error")
    assert not asked, "examples that no test sends"
    with open_server.websocket_connect(URL) as socket:
        socket.send_text(_hello(role="robot", session=heard["welcome"]["session"]))
        heard["command"] = _next(socket, "command")
    for kind, answer in heard.items():
        assert answer.keys() == HEARD[kind].keys(), kind
    assert HEARD.keys() - heard.keys() == {"bye"}
    assert heard["recording"]["csv"].startswith("time,nose_x,nose_y,nose_z,nose_confidence,")


def test_an_observer_sees_what_the_person_sees_and_may_not_move_the_robot(open_server):
    with open_server.websocket_connect(URL) as person, open_server.websocket_connect(URL) as observer:
        person.send_text(_hello())
        session = _next(person, "welcome")["session"]
        observer.send_text(_hello(role="observer", session=session))
        observer.send_text(json.dumps({"type": "reset"}))
        assert _next(observer, "error")["code"] == "read_only"
        mine, its = _next(person, "state"), _next(observer, "state")
        while its["step"] < mine["step"]:
            its = _next(observer, "state")
        while mine["step"] < its["step"]:
            mine = _next(person, "state")
        assert mine == its


def test_who_reconnects_finds_the_robot_where_it_was(open_server):
    with open_server.websocket_connect(URL) as person:
        person.send_text(_hello())
        session = _next(person, "welcome")["session"]
        step = _next(person, "state")["step"]
    with open_server.websocket_connect(URL) as person:
        person.send_text(_hello(session=session))
        assert _next(person, "welcome")["session"] == session
        assert _next(person, "state")["step"] > step
        person.send_text('{"type": "bye"}')


@pytest.mark.parametrize(
    ("first", "code"),
    [
        ("garbage", "bad_json"),
        (b"garbage", "bad_binary"),
        ('{"type": "ping"}', "no_hello"),
        (_hello(protocol=99), "bad_version"),
        (_hello(layout="../../etc/passwd"), "unknown_layout"),
        (_hello(session="../../etc/passwd"), "no_session"),
        (_hello(role="observer", session="main"), "no_session"),
        ("x" * (LARGEST + 1), "too_large"),
    ],
)
def test_a_wrong_beginning_ends_the_connection_with_its_reason(open_server, first, code):
    assert _refused(open_server, first)["code"] == code
    assert open_server.get("/health").json()["clients"] == 0


def test_too_many_messages_end_the_connection(open_server, monkeypatch):
    monkeypatch.setattr(server, "Allowance", lambda clock: Allowance(1.0, 5.0, clock))
    with open_server.websocket_connect(URL) as flood:
        flood.send_text(_hello(role="observer"))
        for _ in range(10):
            flood.send_text('{"type": "ping"}')
        assert _next(flood, "error")["code"] == "too_fast"


def test_silent_clients_cost_no_robot_and_are_let_go(open_server, monkeypatch):
    monkeypatch.setattr(server, "HELLO_S", 0.05)
    robots = open_server.get("/health").json()["robots"]
    for _ in range(3):
        with open_server.websocket_connect(URL) as silent:
            assert _next(silent, "error")["code"] == "no_hello"
    assert open_server.get("/health").json()["robots"] <= robots


def test_a_client_too_many_is_told_so_and_the_others_go_on(open_server):
    sockets = [open_server.websocket_connect(URL) for _ in range(12)]
    try:
        for socket in sockets:
            socket.__enter__()
            socket.send_text(_hello(role="observer"))
            _next(socket, "welcome")
        with open_server.websocket_connect(URL) as late:
            assert _next(late, "error")["code"] == "full"
        sockets[0].send_text('{"type": "ping", "echo": 5}')
        assert _next(sockets[0], "pong")["echo"] == 5
    finally:
        for socket in sockets:
            socket.__exit__(None, None, None)


@pytest.mark.parametrize(
    "headers", [{"origin": "http://evil.org"}, {"origin": "null"}, {"host": "evil.org", "origin": "http://evil.org"}]
)
def test_another_sites_page_and_a_rebound_name_get_http_403(open_server, headers):
    with pytest.raises(WebSocketDisconnect), open_server.websocket_connect(URL, headers=headers):
        pass
    assert open_server.get("/", headers=headers).status_code == 403
    assert open_server.get("/health", headers=headers).status_code == 403


@pytest.mark.parametrize(
    "path",
    ["/..%2f..%2f..%2fetc/passwd", "/../server.py", "/%2e%2e/server.py", "//etc/passwd", "/page/index.html",
     "/index.html%00.py", "/status.js/../../server.py", "/.git/config", "/~root", "/C:\\boot.ini",
     "/?file=/etc/passwd"],
)  # fmt: skip
def test_no_path_leads_out_of_the_pages_folder(open_server, path):
    answer = open_server.get(path)
    inside = {each.read_bytes() for each in server.PAGE.iterdir()}
    assert answer.status_code == 404 or answer.content in inside
    assert answer.status_code != 200 or path == "/?file=/etc/passwd" or "status.js" in path


def test_the_page_may_load_nothing_from_elsewhere(open_server):
    page = open_server.get("/")
    assert "nao-sim live" in page.text
    assert "default-src 'self'" in page.headers["content-security-policy"]
    for name in re.findall(r'(?:src|href)="([^"]+)"', page.text):
        assert open_server.get(f"/{name}").status_code == 200


def test_elsewhere_nobody_without_the_token_gets_a_robot_or_sees_one(guarded_server):
    url = "ws://robot.lab/live"
    for hello in (_hello(), _hello(token="wrong"), _hello(role="observer", token=""), _hello(role="robot")):
        assert _refused(guarded_server, hello, url)["code"] == "bad_token"
    assert guarded_server.get("/health").json()["robots"] == 0
    with guarded_server.websocket_connect(url) as socket:
        socket.send_text(_hello(token=TOKEN))
        welcome = _next(socket, "welcome")
    assert TOKEN not in json.dumps(welcome)


def test_every_example_of_what_clients_say_is_a_message():
    for example in SAID:
        parse(json.dumps(example))
    assert len(SAID) == 9
