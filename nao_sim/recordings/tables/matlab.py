"""MATLAB's `.mat` files (v5 to v7): an array of joints, coordinates and frames in any order, or a track for each joint.

Which axis is which is told by the sizes that known skeletons have, and by which order makes a body.  v7.3 is another
format (HDF5), which is not read.
"""

from __future__ import annotations

from nao_sim.recordings.recording import Recording
from nao_sim.recordings.source import Source
from nao_sim.recordings.tables.matlab_arrays import contents
from nao_sim.recordings.tables.point_arrays import chosen

NAME = "MATLAB .mat"
LOOKS = "a MATLAB .mat file (v5 to v7) with joints x 3 x frames"
KIND = "binary"
_STARTS = {b"MATLAB 5.0 MAT-file": "MATLAB v5 to v7", b"MATLAB 7.3 MAT-file": "MATLAB v7.3", b"\x89HDF\r\n": "HDF5"}


def recognise(source: Source) -> str | None:
    """Why the file is MATLAB's, or None."""
    return next((name for start, name in _STARTS.items() if source.start.startswith(start)), None)


def read(source: Source, reason: str) -> Recording:
    """Read the file.

    Args:
        source: the file; its `person` is the name of a variable, where several may be meant.
        reason: why it is taken for this format.

    Returns:
        The recording: the one array that makes a person.

    Raises:
        RecordingError: none does, or several do (they are named), or the file is damaged or v7.3.
    """
    if source.start.startswith(b"\x89HDF"):
        raise source.error("HDF5, as MATLAB v7.3 has it", "an older format: save('file.mat', ..., '-v7')")
    order, understood = chosen(source, contents(source))
    reason = f"{reason}, variable {order.name} as {order.axes}"
    return understood.recording(source, NAME, reason, len(order.values))
