"""A server that gives away one page and nothing else."""

from __future__ import annotations

import http.client
import threading

import pytest

from nao_sim.errors import UsageError
from nao_sim.viewing.server import PageServer


@pytest.fixture
def ask():
    """Ask a running server; (status, body)."""
    with PageServer("127.0.0.1", 0) as server:
        server.page = b"the page"
        thread = threading.Thread(target=server._server.serve_forever, args=(0.01,), daemon=True)
        thread.start()

        def asked(path: str = "/", method: str = "GET", **headers: str) -> tuple[int, bytes]:
            connection = http.client.HTTPConnection(*server._server.server_address, timeout=10)
            connection.request(method, path, headers=headers)
            answer = connection.getresponse()
            return answer.status, answer.read()

        yield asked
        server._server.shutdown()
        thread.join()


def test_it_serves_the_page(ask):
    assert ask() == ask("/?again") == (200, b"the page")
    assert ask(method="HEAD") == (200, b"")


@pytest.mark.parametrize("path", ["/etc/passwd", "/../../etc/passwd", "//etc/passwd", "/page.js", "/%2e%2e/", "*"])
def test_it_serves_nothing_else(ask, path):
    status, body = ask(path)
    assert status == 404 and b"root:" not in body


def test_pages_of_strangers_do_not_reach_it_under_a_name_of_their_own(ask):
    assert ask(Host="evil.example")[0] == ask(Host="127.0.0.1.evil.example:80")[0] == 404
    assert ask(Host="localhost:1234")[0] == ask(Host="[::1]:80")[0] == 200


def test_a_port_that_is_taken_and_a_host_that_is_none_are_told():
    with PageServer("127.0.0.1", 0) as server:
        port = server._server.server_address[1]
        with pytest.raises(UsageError, match=f"--port {port}: cannot listen there: Address already in use"):
            PageServer("127.0.0.1", port)
    with pytest.raises(UsageError, match=r"--host 999\.1\.1\.1"):
        PageServer("999.1.1.1", 0)


def test_an_interrupt_ends_it_and_gives_the_port_back(monkeypatch):
    with PageServer("127.0.0.1", 0) as server:
        port = server._server.server_address[1]

        def interrupted(poll_interval: float) -> None:
            raise KeyboardInterrupt

        monkeypatch.setattr(server._server, "serve_forever", interrupted)
        server.serve_until_interrupted()
    PageServer("127.0.0.1", port).__exit__(None, None, None)
