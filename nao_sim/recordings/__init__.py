"""Recordings of people and robots: one file a format, one registry, one `load`."""

from nao_sim.recordings.angles.writing import joint_csv_text, write_joint_csv, write_motion
from nao_sim.recordings.recording import Label, Recording
from nao_sim.recordings.registry import FORMATS, Format, load, read
from nao_sim.recordings.source import Source

__all__ = [
    "FORMATS",
    "Format",
    "Label",
    "Recording",
    "Source",
    "joint_csv_text",
    "load",
    "read",
    "write_joint_csv",
    "write_motion",
]
