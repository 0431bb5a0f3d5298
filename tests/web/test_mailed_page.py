"""Pages: one file that asks for nothing, says everything in words, too, and takes what files say for text."""

from __future__ import annotations

import base64
import re
from collections import Counter
from html.parser import HTMLParser
from pathlib import Path

import av
import numpy as np
import pytest
from PIL import Image

from nao_sim.plotting.style import Block
from nao_sim.sections import Section
from nao_sim.web.document import Document, Plot, Verdict, made_by, without_folders
from nao_sim.web.drawing import inline_svg
from nao_sim.web.film import film_in_page
from nao_sim.web.writing import html_text, write_document

EVIL = "<script>alert('x')</script><img src=x onerror=y> & \"quoted\" {{ 7*7 }}"
EMPTY = {"meta", "img", "source", "link", "br", "input", "hr"}


class Reader(HTMLParser):
    """What a browser finds: elements with what they are in, and the text."""

    def __init__(self, html: str) -> None:
        super().__init__(convert_charrefs=True)
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.open: list[str] = []
        self.words: list[str] = []
        self.feed(html)

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag not in EMPTY:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open[-1:] != ["style"]:
            self.words.append(data)

    def all(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.elements if name == tag]


def block(label: str = "a line") -> Block:
    def draw(canvas) -> None:
        axes = canvas.add_subplot()
        axes.plot([0.0, 1.0], [0.0, 1.0])
        axes.fill_between([0.0, 1.0], [0.0, 1.0])
        axes.set(title=label, xlabel="time (s)", ylabel=label)

    return Block(label, draw, lambda _: 2.0)


def film(folder: Path, name: str = "film.mp4", frames: int = 9) -> Path:
    path = folder / name
    with av.open(str(path), "w") as file:
        stream = file.add_stream("libx264" if name.endswith("mp4") else "libvpx-vp9", rate=10)
        stream.width, stream.height, stream.pix_fmt = 64, 48, "yuv420p"
        for place in range(frames):
            shade = np.full((48, 64, 3), 20 * place, np.uint8)
            file.mux(stream.encode(av.VideoFrame.from_ndarray(shade, format="rgb24")))
        file.mux(stream.encode(None))
    return path


@pytest.fixture(scope="module")
def evil(tmp_path_factory) -> str:
    """A page in which every word came from a file that means harm."""
    shown = Plot(block(EVIL), EVIL)
    return html_text(
        Document(
            title=EVIL, lead=EVIL, verdict=Verdict(EVIL, "bad"), warnings=[EVIL], summary={EVIL: [EVIL]},
            film=film_in_page(film(tmp_path_factory.mktemp("film"))), key=shown,
            plots=[shown, Plot(block(), "x", wide=True)],
            sections=[Section(EVIL, (EVIL, "b"), [(EVIL, EVIL)], (EVIL,))], remarks=[EVIL],
            made={"command": EVIL, EVIL: EVIL},
        )
    )  # fmt: skip


def test_what_files_say_is_text_and_never_markup(evil):
    page = Reader(evil)
    assert page.open == [] and not page.all("script")
    assert not [name for _, attributes in page.elements for name in attributes if name.startswith("on")]
    assert {attributes["src"][:5] for attributes in page.all("img")} == {"data:"}
    words = " ".join(page.words)
    assert words.count("<script>alert('x')</script>") >= 10 and "{{ 7*7 }}" in words and "49" not in words


def test_a_page_asks_for_nothing_from_anywhere(evil):
    policy = next(each["content"] for each in Reader(evil).all("meta") if each.get("http-equiv"))
    assert policy.startswith("default-src 'none'")
    for _, attributes in Reader(evil).elements:
        for name in ("src", "href", "xlink:href", "poster", "action", "srcset"):
            assert (attributes.get(name) or "#").startswith(("#", "data:"))
        assert "url(" not in (attributes.get("style") or "") or "url(#" in attributes["style"]
    assert not re.search(r"@import|url\(['\"]?(?!#|data:)", re.sub(r"data:[\w/]+;base64,[\w+/=]+", "", evil))


def test_every_picture_has_words_and_every_name_is_there_once(evil):
    page = Reader(evil)
    names = Counter(attributes["id"] for _, attributes in page.elements if "id" in attributes)
    assert max(names.values()) == 1
    for _, attributes in page.elements:
        for name in ("href", "xlink:href"):
            if (attributes.get(name) or "").startswith("#"):
                assert attributes[name][1:] in names
        for name in ("aria-labelledby", "aria-describedby"):
            assert not attributes.get(name) or attributes[name] in names
        assert all(part in names for part in re.findall(r"url\(#([^)]+)\)", str(attributes)))
    assert all(each["alt"] for each in page.all("img"))
    assert all(each["role"] == "img" and each["aria-labelledby"] for each in page.all("svg"))
    assert len(page.all("svg")) == 4 and len(page.all("h1")) == 1 and page.all("html") == [{"lang": "en"}]
    assert all(each["scope"] in ("col", "row") for each in page.all("th"))
    assert any(each.get("name") == "viewport" for each in page.all("meta"))


def _contrast(first: str, second: str) -> float:
    """Contrast ratio of two colours, WCAG 2."""

    def light(colour: str) -> float:
        values = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0
        return float(
            np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4) @ [0.2126, 0.7152, 0.0722]
        )

    lighter, darker = sorted((light(first), light(second)), reverse=True)
    return (lighter + 0.05) / (darker + 0.05)


def test_words_can_be_read_by_day_by_night_and_on_paper(evil):
    schemes = re.findall(r":root \{[^}]*--paper[^}]*\}", evil)
    assert len(schemes) == 3 and "prefers-color-scheme: dark" in evil and "@media print" in evil
    for scheme in schemes:
        colours = dict(re.findall(r"--(\w+): (#\w{6})", scheme))
        for words in ("ink", "quiet", "good", "fair", "bad"):
            assert min(_contrast(colours[words], colours[ground]) for ground in ("paper", "shade")) >= 4.5


@pytest.mark.parametrize(("name", "kind"), [("film.mp4", "video/mp4"), ("film.webm", "video/webm")])
def test_a_film_is_in_the_page_with_a_picture_of_its_middle(name, kind, tmp_path):
    path = film(tmp_path, name)
    found = film_in_page(path)
    assert found.kind == kind and base64.b64decode(found.data) == path.read_bytes() and found.size == (64, 48)
    html = html_text(Document("a", "b", film=found))
    (video,) = Reader(html).all("video")
    assert "controls" in video and "autoplay" not in video and video["poster"].startswith("data:image/jpeg")
    assert Reader(html).all("source")[0]["type"] == kind


def test_a_film_too_large_to_be_mailed_is_named_and_shown_as_a_picture(tmp_path):
    path = film(tmp_path)
    found = film_in_page(path, largest_mb=path.stat().st_size / 1e6 / 2)
    assert found.data == "" and "film.mp4" in found.words and "too large" in found.words
    page = Reader(html_text(Document("a", "b", film=found)))
    assert not page.all("video") and page.all("img")[0]["src"].startswith("data:image/jpeg")


def test_a_folder_of_frames_and_a_gif_have_a_picture(tmp_path):
    folder = tmp_path / "frames.png"
    folder.mkdir()
    for place in range(3):
        Image.new("RGB", (80, 40), (80 * place, 0, 0)).save(folder / f"{place}.png")
    assert film_in_page(folder).size == (80, 40) and "frames.png" in film_in_page(folder).words
    frames = [Image.new("P", (30, 20), place) for place in range(3)]
    frames[0].save(tmp_path / "a.gif", save_all=True, append_images=frames[1:])
    page = Reader(html_text(Document("a", "b", film=film_in_page(tmp_path / "a.gif"))))
    assert page.all("img")[0]["src"].startswith("data:image/gif")


def test_why_there_is_no_film_is_said():
    assert "There is none: no OpenGL" in " ".join(Reader(html_text(Document("a", "b", no_film="no OpenGL"))).words)


@pytest.mark.parametrize(
    ("text", "kept"),
    [
        ("/home/anna/data/wave.csv: 3 frames", "wave.csv: 3 frames"),
        ("the table of /home/anna/a b.csv", "the table of a b.csv"),
        ("up to 3 rad/s, 24/7, and/or", "up to 3 rad/s, 24/7, and/or"),
        ("see docs/layouts.md", "see docs/layouts.md"),
    ],
)
def test_files_are_called_by_their_names_alone(text, kept):
    assert without_folders(text) == kept


def test_a_page_says_how_it_was_made():
    made = made_by("nao-sim play a.csv", {"recording": "a.csv"})
    assert made["command"] == "nao-sim play a.csv" and made["nao_sim"] and "mujoco 3." in made["with"]


def test_a_page_is_there_whole_or_not_at_all(tmp_path, monkeypatch):
    path = tmp_path / "new" / "a.html"
    write_document(Document("a", "b"), path)
    before = path.read_bytes()
    monkeypatch.setattr("nao_sim.plotting.style.stacked", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        write_document(Document("a", "b", plots=[Plot(block(), "x")]), path)
    assert path.read_bytes() == before and {each.name for each in path.parent.iterdir()} == {"a.html", ".gitignore"}


def test_a_drawing_keeps_its_links_inside_itself():
    text = (
        '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="9pt">'
        '<style>*{}</style><defs><path id="a"/><clipPath id="c"/></defs>'
        '<use xlink:href="#a" clip-path="url(#c)"/></svg>'
    )
    made = inline_svg(text, "p1", "<t>", "what & why")
    assert 'id="p1-a"' in made and '"#p1-a"' in made and "url(#p1-c)" in made and "<style" not in made
    assert "&lt;t&gt;" in made and "what &amp; why" in made and "width=" not in made
