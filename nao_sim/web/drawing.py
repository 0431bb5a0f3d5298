"""A plot inside a page: an SVG whose names are its own, with words for those who cannot see it."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET

_SVG, _LINK = "http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"
_REFERENCE = re.compile(r"url\(#")
_GENERAL = "stroke-linejoin: round; stroke-linecap: butt"  # what the style sheet in matplotlib's files says


def inline_svg(text: str, name: str, title: str, about: str) -> str:
    """An SVG of matplotlib's for the middle of a page.

    Args:
        text: the file.
        name: unique in the page; begins all its names.
        title: what it shows.
        about: what is to be seen.

    Returns:
        The element, as wide as there is room.
    """
    ET.register_namespace("", _SVG)
    ET.register_namespace("xlink", _LINK)
    root = ET.fromstring(text)
    for parent in list(root.iter()):
        for child in list(parent):
            if child.tag in (f"{{{_SVG}}}metadata", f"{{{_SVG}}}style"):
                parent.remove(child)
    for element in root.iter():
        _rename(element, f"{name}-")
    for key in ("width", "height", "version"):
        root.attrib.pop(key, None)
    spoken = {"aria-labelledby": f"{name}-title", "aria-describedby": f"{name}-desc"}
    root.attrib |= {"role": "img", **spoken, "style": _GENERAL, "class": "drawing"}
    for place, (tag, words) in enumerate({"title": title, "desc": about}.items()):
        told = ET.Element(f"{{{_SVG}}}{tag}", {"id": f"{name}-{tag}"})
        told.text = words
        root.insert(place, told)
    return ET.tostring(root, encoding="unicode")


def _rename(element: ET.Element, prefix: str) -> None:
    """Put `prefix` before a name and before all references to names."""
    for key, value in element.attrib.items():
        if key == "id":
            element.set(key, prefix + value)
        elif key in ("href", f"{{{_LINK}}}href") and value.startswith("#"):
            element.set(key, f"#{prefix}{value[1:]}")
        elif "url(#" in value:
            element.set(key, _REFERENCE.sub(f"url(#{prefix}", value))
