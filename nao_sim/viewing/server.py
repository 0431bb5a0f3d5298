"""Serves one page, and nothing else of this machine."""

from __future__ import annotations

import ipaddress
import socket
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from socketserver import TCPServer
from types import TracebackType

from nao_sim.errors import UsageError

_WAIT = b"<!doctype html><meta http-equiv=refresh content=1><title>nao-sim</title><p>The robot is still performing."


class PageServer:
    """A server of one page; use it in a `with` block.  It listens at once, so that its port is its own.

    Args:
        host: the address to listen at.
        port: the port, 0 for any that is free.

    Attributes:
        page: what is served; until it is there a page that asks to wait.

    Raises:
        UsageError: nobody can listen there.
    """

    def __init__(self, host: str, port: int) -> None:
        self.page = _WAIT
        self._host = host
        try:
            if not host:
                raise ValueError("no address")  # which sockets take for every one that this machine has
            self._server = _Server((host, port), _handler(self))
        except (OSError, ValueError, OverflowError) as error:
            reason = getattr(error, "strerror", None) or str(error)
            raise UsageError(
                f"--host {host} --port {port}: cannot listen there: {reason}; "
                "expected an address of this machine and a free port (0 takes one)"
            ) from None

    @property
    def url(self) -> str:
        """Where a browser finds the page."""
        host = f"[{self._host}]" if ":" in self._host else self._host
        return f"http://{host}:{self._server.server_address[1]}/"

    def allows(self, asked: str) -> bool:
        """Whether a request that names this host may be answered.

        A page of somebody else's may send a browser here under a name of its own (DNS rebinding): a server for this
        machine alone answers to the machine's own names only.
        """
        name = asked.rsplit(":", 1)[0].strip("[]") if not asked.endswith("]") else asked.strip("[]")
        return not _is_loopback(self._host) or name == self._host or _is_loopback(name)

    def serve_until_interrupted(self) -> None:
        """Answer until Ctrl-C."""
        try:
            self._server.serve_forever(poll_interval=0.2)
        except KeyboardInterrupt:
            print()

    def __enter__(self) -> PageServer:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Give the port back."""
        self._server.server_close()


class _Server(ThreadingHTTPServer):
    daemon_threads = True
    block_on_close = False  # a browser that keeps its connection open does not keep us

    def __init__(self, address: tuple[str, int], handler: type[BaseHTTPRequestHandler]) -> None:
        self.address_family = socket.AF_INET6 if ":" in address[0] else socket.AF_INET
        super().__init__(address, handler)

    def server_bind(self) -> None:
        """Listen; whose name the address is may take a while to find out, and nobody asks."""
        TCPServer.server_bind(self)

    def handle_error(self, request: object, client_address: object) -> None:
        """A browser that went away is no news."""


def _handler(owner: PageServer) -> type[BaseHTTPRequestHandler]:
    class Handler(BaseHTTPRequestHandler):
        server_version, sys_version = "nao-sim", ""

        def do_GET(self) -> None:
            self._answer(with_body=True)

        def do_HEAD(self) -> None:
            self._answer(with_body=False)

        def log_message(self, format: str, *args: object) -> None:
            """Nothing on the terminal."""

        def _answer(self, *, with_body: bool) -> None:
            known = self.path.partition("?")[0] == "/"
            if not known or not owner.allows(self.headers.get("Host", "")):
                self.send_error(404)
                return
            self.send_response(200)
            for name, value in (
                ("Content-Type", "text/html; charset=utf-8"),
                ("Content-Length", str(len(owner.page))),
                ("Cache-Control", "no-store"),
                ("X-Content-Type-Options", "nosniff"),
                ("X-Frame-Options", "DENY"),
                ("Referrer-Policy", "no-referrer"),
            ):
                self.send_header(name, value)
            self.end_headers()
            if with_body:
                self.wfile.write(owner.page)

    return Handler


def _is_loopback(name: str) -> bool:
    try:
        return name == "localhost" or ipaddress.ip_address(name).is_loopback
    except ValueError:
        return False
