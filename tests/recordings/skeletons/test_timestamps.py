"""Units that names tell, and clock times."""

import pytest

from nao_sim.recordings.skeletons.timestamps import clock, unit_named


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("timestamp_ms", 1e-3), ("Time (Seconds)", 1.0), ("timeMs", 1e-3), ("time_s", 1.0), ("t [us]", 1e-6),
        ("timestamp_usec", 1e-6), ("time(ns)", 1e-9), ("ticks", 1e-7), ("seconds", 1.0), ("milliseconds", 1e-3),
        ("time", None), ("t", None), ("s", None), ("timestamp", None), ("frame", None), ("", None),
    ],
)  # fmt: skip
def test_the_unit_is_the_last_word_of_a_name(name, unit):
    assert unit_named(name) == unit


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("00:00:01.5", 1.5),
        ("1:02:03", 3723.0),
        ("02:03.25", 123.25),
        ("10:15:30:250", 36930.25),
        ("10:15:30,250", 36930.25),
        ("12:00:01.5 AM", 1.5),
        ("01:00:00 p.m.", 46800.0),
        ("13:00:00 PM", None),
        ("10:15:30:12", None),
        ("1:2:3:4", None),
        ("soon", None),
        ("12", None),
        ("", None),
    ],
)
def test_clock_times_are_seconds(text, seconds):
    assert clock(text) == (None if seconds is None else pytest.approx(seconds))


def test_dates_differ_by_seconds():
    first, second = clock("2024-05-01T10:00:00.250"), clock("2024-05-01 10:00:01")
    assert first is not None and second is not None and second - first == pytest.approx(0.75)
    assert clock("2024-13-01") is None


@pytest.mark.parametrize(
    "texts",
    [
        ("1/2/2020 11:59:59.5 PM", "1/3/2020 12:00:00 AM"),
        ("31.12.2020 23:59:59,500", "01.01.2021 00:00:00,000"),
        ("31/12/2020 23:59:59.5", "31/12/2020, 24:00:00"),
        ("12-31-2020 10:00:00:250", "12-31-2020 10:00:00:750"),
    ],
)
def test_dates_of_every_country_differ_by_seconds(texts):
    first, second = map(clock, texts)
    assert first is not None and second is not None and second - first == pytest.approx(0.5)
    assert clock("31.13.2020 10:00:00") is None
