"""What a drawing is made of: parts, and the few materials they come in."""

from __future__ import annotations

from dataclasses import dataclass

from .meshes import Mesh


@dataclass(frozen=True)
class Part:
    """One mesh of one material on one link.

    Attributes:
        link: the link in whose frame the mesh is drawn.
        material: a key of `MATERIALS`.
        mesh: the triangles.
    """

    link: str
    material: str
    mesh: Mesh

    @property
    def file(self) -> str:
        """The name of its OBJ file."""
        return f"{self.link.removesuffix('_link')}_{self.material}.obj"

    @property
    def mirror_to(self) -> str | None:
        """The right-side link that wears the mirror image, None for the middle of the robot."""
        if self.link.startswith("l_"):
            return "r_" + self.link[2:]
        return "R" + self.link[1:] if self.link[0] == "L" else None


MATERIALS = {
    "shell": {
        "rgba": [0.90, 0.895, 0.88, 1.0],
        "specular": 0.35,
        "shininess": 0.45,
        "emission": 0.0,
        "doc": "the white plastic of the body",
    },
    "panel": {
        "rgba": [0.88, 0.25, 0.07, 1.0],
        "specular": 0.4,
        "shininess": 0.5,
        "emission": 0.0,
        "doc": "the coloured plates; change this one to recolour the robot",
    },
    "joint": {
        "rgba": [0.42, 0.43, 0.45, 1.0],
        "specular": 0.2,
        "shininess": 0.25,
        "emission": 0.0,
        "doc": "grey plastic: joints, seams, soles",
    },
    "dark": {
        "rgba": [0.055, 0.057, 0.065, 1.0],
        "specular": 0.5,
        "shininess": 0.7,
        "emission": 0.0,
        "doc": "near-black: eye sockets, lenses, grilles, tactile strip",
    },
    "led": {
        "rgba": [0.45, 0.74, 1.0, 1.0],
        "specular": 0.2,
        "shininess": 0.4,
        "emission": 0.4,
        "doc": "light rings of eyes and ears, chest button",
    },
}
