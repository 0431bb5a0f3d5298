"""What a client is told when something is wrong."""

from __future__ import annotations

from nao_sim.errors import NaoSimError


class LiveError(NaoSimError):
    """A message or a client that cannot be served.

    Args:
        code: one word that a program can act on; docs/live.md lists them.
        message: what was found and what was expected.
    """

    def __init__(self, code: str, message: str) -> None:
        self.code = code
        super().__init__(message)
