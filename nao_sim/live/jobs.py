"""Several things at once for one connection, ended together."""

from __future__ import annotations

import asyncio
from collections.abc import Collection


async def end(jobs: Collection[asyncio.Task[None]]) -> None:
    """Cancel tasks and wait until they have ended, whatever they end with."""
    for job in jobs:
        job.cancel()
    await asyncio.wait(jobs)  # not gather: that would pass a child's cancellation on for one's own
    for job in jobs:
        if not job.cancelled():
            job.exception()  # seen: nobody need be told that it was not
