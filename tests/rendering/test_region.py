"""The part of a picture that can change."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_sim.rendering.presets import camera_names, load_camera
from nao_sim.rendering.region import region_of, shadow_spheres
from nao_sim.rendering.stage import view_of

SIZE = (640, 480)
coordinate = st.floats(-0.4, 0.4)
point = st.tuples(coordinate, coordinate, st.floats(0.0, 0.7)).map(np.array)
direction = st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, 1)).map(np.array)
cameras = st.sampled_from([name for name in camera_names() if name != "head"])


def pixel(view, position):
    """Where a pinhole camera sees a point: (column, row from below)."""
    offset = position - view.position
    depth = offset @ view.forward
    right = np.cross(view.forward, view.up)
    scale = view.size[1] / (2 * view.slope * depth)
    return view.size[0] / 2 + offset @ right * scale, view.size[1] / 2 + offset @ view.up * scale


@given(cameras, st.lists(st.tuples(point, st.floats(0.001, 0.15)), min_size=1, max_size=5), direction)
def test_every_point_of_every_sphere_is_inside(name, spheres, towards):
    view = view_of(load_camera(name), SIZE)
    centres, radii = np.array([c for c, _ in spheres]), np.array([r for _, r in spheres])
    region = region_of(view, centres, radii)
    if region is None or np.linalg.norm(towards) < 1e-3:
        return
    assert region.left >= 0 and region.bottom >= 0
    assert region.left + region.width <= SIZE[0] and region.bottom + region.height <= SIZE[1]
    for centre, radius in spheres:
        column, row = pixel(view, centre + radius * towards / np.linalg.norm(towards))
        if 0 <= column < SIZE[0] and 0 <= row < SIZE[1]:
            assert region.left <= column <= region.left + region.width
            assert region.bottom <= row <= region.bottom + region.height


@given(point, st.floats(0.01, 0.2), direction, st.floats(-1, 1), st.floats(-1, 1), st.floats(-0.1, 0.0))
def test_every_shadow_is_inside_its_sphere(centre, radius, towards, east, north, floor):
    if np.linalg.norm(towards) < 1e-3:
        return
    light = np.array([east, north, -1.0]) / np.linalg.norm([east, north, -1.0])
    at = centre + radius * towards / np.linalg.norm(towards)
    shadow = at + light * (floor - at[2]) / light[2]
    (middle,), (reach,) = shadow_spheres(centre[None], np.array([radius]), light, floor)
    assert np.linalg.norm(shadow - middle) <= reach + 1e-9


@settings(max_examples=20)
@given(cameras)
def test_when_a_sphere_holds_the_camera_expect_the_whole_picture(name):
    view = view_of(load_camera(name), SIZE)
    assert region_of(view, view.position[None], np.array([0.1])) is None
