"""Recordings of people and robots: one file a format, one registry, one `load`."""

from nao_sim.recordings.recording import Label, Recording
from nao_sim.recordings.registry import FORMATS, Format, load
from nao_sim.recordings.writing import joint_csv_text, write_joint_csv

__all__ = ["FORMATS", "Format", "Label", "Recording", "joint_csv_text", "load", "write_joint_csv"]
