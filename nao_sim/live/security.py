"""Who may connect, and how much at once.

On loopback, the default, everybody on this machine may; but no web page of
somebody else's may use the visitor's browser to get there (cross-site WebSocket
hijacking, DNS rebinding): the page's origin must be this server's own, and the
server must be called by a loopback name.  On any other address a token is
needed, too.
"""

from __future__ import annotations

import hmac
import ipaddress
import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import urlsplit

from nao_sim.errors import UsageError
from nao_sim.live.clock import Clock, monotonic
from nao_sim.live.problem import LiveError

SHORTEST_TOKEN = 12
MESSAGES, BURST = 240.0, 480.0  # a second, and at once; a fast sensor sends 120 frames a second
_LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "::1"})


def is_loopback(host: str) -> bool:
    """Whether an address to listen at is this machine's own alone."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


@dataclass(frozen=True)
class Gate:
    """Decides who may connect.

    Attributes:
        loopback: whether the server listens on this machine's own address alone.
        token: what clients must know; None where they need not.
        origins: web pages' origins that are let in besides the server's own.
    """

    loopback: bool = True
    token: str | None = None
    origins: frozenset[str] = frozenset()

    def check_request(self, headers: Mapping[str, str]) -> None:
        """Refuse a web page that is not ours, and a name that is not this machine's.

        Args:
            headers: of the request, names in lower case.

        Raises:
            LiveError: it is refused.
        """
        host = headers.get("host", "")
        try:
            name, origin = urlsplit(f"//{host}").hostname or "", headers.get("origin")
        except ValueError:
            raise LiveError("bad_host", f"Host {host[:60]!a}; expected a name") from None
        if self.loopback and name not in _LOOPBACK_NAMES:
            raise LiveError("bad_host", f"Host {host[:60]!a}; expected localhost or 127.0.0.1")
        if origin is None or origin in self.origins or origin in {f"http://{host}", f"https://{host}"}:
            return
        raise LiveError("bad_origin", f"a page of {origin[:60]!a}; expected one of this server, or --allow-origin")

    def check_token(self, token: str | None) -> None:
        """Refuse who does not know the token.

        Raises:
            LiveError: it is refused.
        """
        if self.token is not None and not hmac.compare_digest((token or "").encode(), self.token.encode()):
            raise LiveError("bad_token", "no token, or a wrong one; expected the one that the server printed")


def gate_for(host: str, token: str | None, origins: tuple[str, ...] = ()) -> Gate:
    """The gate of a server that listens at an address; open ones get a token where none is told.

    Raises:
        UsageError: the token is too short to keep anybody out.
    """
    if token is not None and len(token) < SHORTEST_TOKEN:
        raise UsageError(f"--token of {len(token)} characters; expected {SHORTEST_TOKEN} or more, hard to guess")
    loopback = is_loopback(host)
    if token is None and not loopback:
        token = secrets.token_urlsafe(18)
    return Gate(loopback, token, frozenset(origins))


class Allowance:
    """How many messages a client may still send: a bucket that fills again; it has a state.

    Args:
        rate: messages a second.
        burst: messages at once.
        clock: what time it is.
    """

    def __init__(self, rate: float = MESSAGES, burst: float = BURST, clock: Clock = monotonic) -> None:
        self._rate, self._burst, self._clock = rate, burst, clock
        self._left, self._last = burst, clock()

    def spend(self) -> None:
        """Count a message.

        Raises:
            LiveError: it is one too many.
        """
        now = self._clock()
        self._left = min(self._burst, self._left + self._rate * (now - self._last)) - 1.0
        self._last = now
        if self._left < 0.0:
            raise LiveError("too_fast", f"more than {self._rate:g} messages a second; expected fewer")
