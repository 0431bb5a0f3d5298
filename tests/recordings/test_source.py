"""Files that are no recording: each is one clear sentence and never a traceback."""

import os
import struct
import zlib
from pathlib import Path

import pytest

from nao_sim.errors import RecordingError
from nao_sim.recordings import load
from nao_sim.recordings.source import LONGEST_LINE, Source


def told(path, **options):
    with pytest.raises(RecordingError) as caught:
        load(path, **options)
    message = str(caught.value)
    assert message.startswith(str(path)) and "\n" not in message and "; expected " in message
    return message


def png() -> bytes:
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 0, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + header + chunk(b"IDAT", zlib.compress(b"\0\0")) + chunk(b"IEND", b"")


HEADER = "time,HeadYaw_deg\n"
CONTENTS = {
    "zero bytes": (b"", "an empty file (0 bytes)"),
    "a line end only": (b"\n", "only blank lines and comments"),
    "comments only": (b"# a\n# b\n\n", "only blank lines and comments"),
    "a picture renamed": (png(), "a PNG picture"),
    "a photograph renamed": (b"\xff\xd8\xff\xe0 JFIF", "a JPEG picture"),
    "a spreadsheet renamed": (b"PK\x03\x04 xl/workbook.xml", "a ZIP archive or spreadsheet"),
    "a compressed file": (b"\x1f\x8b\x08 data", "damaged compressed data"),
    "binary data": (b"time,HeadYaw_deg\0\1\2", "binary data"),
    "binary data late": ((HEADER + "0,1\n" * 3000).encode() + b"\0\0\n", "line 3002: bytes that are not UTF-8"),
    "UTF-16": (HEADER.encode("utf-16"), "UTF-16 text"),
    "UTF-16 without a mark": (HEADER.encode("utf-16-le"), "binary data"),
    "UTF-32": (HEADER.encode("utf-32"), "UTF-16 text"),
    "Latin-1": ("# Zoë\n".encode("latin-1") + HEADER.encode(), "line 1: bytes that are not UTF-8 text"),
    "Latin-1 later": (HEADER.encode() + "0,1\n1,é\n".encode("latin-1"), "line 3: bytes that are not UTF-8 text"),
    "an endless line": (b"time," + b"9" * (LONGEST_LINE + 10), f"line 1: more than {LONGEST_LINE} characters"),
    "an endless later line": (HEADER.encode() + b"0," + b"9" * LONGEST_LINE, "line 2: more than"),
    "numbers without a header": (b"0,1,2\n1,2,3\n", "line 1: numbers without a header"),
    "prose": (b"# mine\nDear diary, today\n", "line 2: 'Dear diary, today', which no reader knows"),
    "markup": (b"<?xml version='1.0'?>\n<a/>\n", "which no reader knows"),
}


@pytest.mark.parametrize("kind", CONTENTS)
def test_a_file_that_is_no_recording_is_told_so(tmp_path, kind):
    content, words = CONTENTS[kind]
    path = tmp_path / "motion.csv"
    path.write_bytes(content)
    assert words in told(path)


@pytest.mark.parametrize("content", [b"0,1,2\n", b"hello\n", b"# only this\n"])
def test_an_unknown_file_is_told_where_the_formats_are_listed(tmp_path, content):
    path = tmp_path / "motion.csv"
    path.write_bytes(content)
    message = told(path)
    assert "nao-sim formats" in message or "--layout" in message


def test_text_that_nobody_knows_may_have_a_layout(tmp_path):
    path = tmp_path / "lab.txt"
    path.write_text("Laboratory 7\n1 2 3\n")
    assert "--layout" in told(path)


def test_a_missing_file(tmp_path):
    assert "no such file" in told(tmp_path / "none.csv")


def test_a_file_in_a_folder_that_is_a_file(tmp_path):
    (tmp_path / "a").write_text("x")
    assert "cannot be read (not a directory)" in told(tmp_path / "a" / "b.csv")


def test_a_folder(tmp_path):
    assert "a folder; expected a file" in told(tmp_path)


def test_a_device():
    assert "a device or pipe" in told(Path(os.devnull))


def test_a_name_that_no_file_can_have(tmp_path):
    assert "cannot be read" in told(tmp_path / ("x" * 5000))
    with pytest.raises(RecordingError, match="cannot be read"):
        load("a\0b.csv")


def test_a_file_without_permission(tmp_path, monkeypatch):
    path = tmp_path / "locked.csv"
    path.write_text(HEADER)

    def locked(*_args, **_options):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "open", locked)
    assert "cannot be read (permission denied)" in told(path)


def test_a_file_that_goes_away_while_it_is_read(tmp_path):
    path = tmp_path / "short_lived.csv"
    path.write_text(HEADER)
    source = Source(path)
    path.unlink()
    with pytest.raises(RecordingError, match="no such file"):
        source.header()


def test_a_long_found_text_is_shortened(tmp_path):
    path = tmp_path / "x.csv"
    path.write_text("word " * 1000)
    assert told(path).count("word") < 20


def test_the_extension_does_not_matter(tmp_path):
    path = tmp_path / "motion.png"
    path.write_text(HEADER + "0,1\n")
    assert load(path).format == "joint-angle CSV"
