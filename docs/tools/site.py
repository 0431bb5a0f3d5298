"""What makes a site of the tree: MkDocs calls these functions (`hooks` in mkdocs.yml).

Pages link to files outside docs/ as they are in the tree, so that the links hold wherever the tree is read.  Every file
that is linked so joins the site under its own path, README.md of the root as five_minutes.md.
"""

from __future__ import annotations

import posixpath
import re
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

ROOT = Path(__file__).resolve().parents[2]
START = "five_minutes.md"
_LINK = re.compile(r"(?<=\]\()(?![a-z]+:|#)(?P<path>[^)#\s]+)(?P<anchor>#[^)\s]*)?(?=\))")
_CODE = re.compile(r"^```.*?^```$", re.DOTALL | re.MULTILINE)


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add what pages link to."""
    waiting = [f"docs/{file.src_uri}" for file in files.documentation_pages()]
    waiting += [path for path in ("README.md",) if (ROOT / path).is_file()]
    seen: set[str] = set()
    while waiting:
        path = waiting.pop()
        if path in seen:
            continue
        seen.add(path)
        if not path.startswith("docs/"):
            files.append(File.generated(config, uri(path), abs_src_path=str(ROOT / path)))
        if path.endswith(".md"):
            waiting += [target for target in targets(path) if (ROOT / target).is_file()]
    return files


def targets(document: str) -> list[str]:
    """The files of the tree that a document links to, from the root."""
    text = _CODE.sub("", (ROOT / document).read_text(encoding="utf-8"))
    return [meant(document, found["path"]) for found in _LINK.finditer(text)]


def meant(document: str, link: str) -> str:
    """The file that a link in a document means, from the root: of a folder its README."""
    path = posixpath.normpath(posixpath.join(posixpath.dirname(document), link))
    return f"{path}/README.md" if (ROOT / path).is_dir() else path


def uri(path: str) -> str:
    """Where a file of the tree is in the site."""
    return START if path == "README.md" else path.removeprefix("docs/")


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Turn links of the tree into those of the site; the others are left for MkDocs to complain of."""
    inside = (ROOT / "docs" / page.file.src_uri).is_file()
    document = f"docs/{page.file.src_uri}" if inside else page.file.src_uri
    document = "README.md" if page.file.src_uri == START else document

    def moved(link: re.Match[str]) -> str:
        target = uri(meant(document, link["path"]))
        if files.get_file_from_path(target) is None:
            return link[0]
        here = posixpath.dirname(page.file.src_uri)
        return f"{posixpath.relpath(target, here or '.')}{link['anchor'] or ''}"

    return _LINK.sub(moved, markdown)
