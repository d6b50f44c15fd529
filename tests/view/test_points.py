"""Particles as spheres: where they are drawn, which is in front, and what their colours say."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scenery import BOUNDS, FRONT, POINTS, SIZE, changed, frame, picture

import fontana
from fontana.gl.camera import Camera
from fontana.gl.color_maps import color_map_table
from fontana.gl.frame_data import FrameData, Look
from fontana.gl.renderer import Renderer
from fontana.render.legend import add_legend

NOBODY = frame(np.zeros((0, 3)))


def hue(colour: np.ndarray) -> np.ndarray:
    """A colour without its brightness, from what a screen shows back to linear light."""
    linear = (np.asarray(colour) / 255.0) ** 2.2
    return linear / np.linalg.norm(linear)


def test_a_sphere_has_the_silhouette_of_a_sphere(renderer):
    centre, radius = np.array([0.3, 0.7, 0.2]), 0.15
    seen = changed(picture(renderer, frame([centre], radius=radius)), picture(renderer, NOBODY))
    rows, columns = np.nonzero(seen)
    pixels, depth = FRONT.project(centre[None], SIZE)
    expected = radius * SIZE[1] / (2 * np.tan(np.radians(15)) * np.sqrt(depth[0] ** 2 - radius**2))
    assert np.array([columns.mean() + 0.5, rows.mean() + 0.5]) == pytest.approx(pixels[0], abs=0.6)
    assert np.sqrt(seen.sum() / np.pi) == pytest.approx(expected, abs=0.5)
    assert max(np.ptp(rows), np.ptp(columns)) + 1 <= 2 * expected + 2


def test_a_sphere_beside_the_camera_is_not_cut_off(renderer):
    """Its silhouette is an ellipse that is larger than its radius at that depth."""
    near, radius, size = np.array([[0.55, 0.5, 2.8]]), 0.6, (240, 90)
    seen = changed(picture(renderer, frame(near, radius=radius), size=size), picture(renderer, NOBODY, size=size))
    columns = np.nonzero(seen[45])[0]
    scale = 90 / (2 * np.tan(np.radians(15)))
    left_edge = np.arctan2(0.55, 1.2) - np.arcsin(radius / np.hypot(0.55, 1.2))
    assert columns.min() == pytest.approx(120 + scale * np.tan(left_edge), abs=1.5)
    assert columns.max() == 239


def test_the_nearer_sphere_is_in_front(renderer):
    both = frame([[0.0, 0.5, 0.5], [0.0, 0.5, -0.5]], speed=[0.0, 1.0])
    turned = frame([[0.0, 0.5, -0.5], [0.0, 0.5, 0.5]], speed=[0.0, 1.0])
    middle = [picture(renderer, data)[45, 60] for data in (both, turned)]
    table = color_map_table("turbo")
    assert hue(middle[0]) @ hue(255 * table[0]) > 0.95
    assert hue(middle[1]) @ hue(255 * table[-1]) > 0.95


def test_spheres_cut_each_other_where_they_meet(renderer):
    """Depth belongs to the pixel: of two that overlap each shows what is in front, not the nearer one all of it."""
    radius, apart, ahead = 0.4, 0.16, 0.2
    data = frame([[-apart, 0.5, 0.0], [apart, 0.5, ahead]], speed=[0.0, 1.0], radius=radius)
    camera = Camera.looking([0.0, 0.5, 40.0], [0.0, 0.5, 0.0], 1.3)  # from far away: rays are parallel
    row = picture(renderer, data, camera=camera)[45, 20:100]
    x = (np.arange(20, 100) + 0.5 - 60) * 2 * 40 * np.tan(np.radians(0.65)) / 90
    slow, fast = (np.sqrt(np.clip(radius**2 - (x - c) ** 2, 0, None)) for c in (-apart, apart))
    ends = [hue(255 * color) for color in color_map_table("turbo")[[0, -1]]]
    is_fast = np.array([hue(pixel) @ ends[1] > hue(pixel) @ ends[0] for pixel in row])
    both = (slow > 0) & (fast > 0)
    assert (is_fast[both] != (ahead + fast > slow)[both]).sum() <= 1


@pytest.mark.parametrize("color_by", ["speed", "density", "pressure", "id"])
def test_colours_follow_the_attribute(renderer, color_by):
    places = [[-0.5, 0.5, 0.0], [0.5, 0.5, 0.0]]
    values = {
        "speed": frame(places, speed=[1.0, 3.0]),
        "density": frame(places, density=np.array([1.0, 3.0])),
        "pressure": frame(places, pressure=np.array([1.0, 3.0])),
        "id": frame(places, id=np.array([1, 3])),
    }
    look = Look("points", color_by, (0.0, 4.0), "viridis")
    image = picture(renderer, values[color_by], look=look)
    for place, share in zip(places, (0.25, 0.75), strict=True):
        x, y = FRONT.project(np.array([place]), SIZE)[0][0].astype(int)
        expected = color_map_table("viridis")[round(255 * share)]
        assert hue(image[y, x]) @ hue(255 * expected) > 0.995


def test_values_beyond_the_range_have_the_colour_of_its_end(renderer):
    far, end = (picture(renderer, frame([[0, 0.5, 0]], speed=speed)) for speed in (50.0, 1.0))
    assert np.array_equal(far, end)


def test_without_a_range_that_of_the_frame_is_taken(renderer):
    data = frame([[-0.4, 0.5, 0.0], [0.4, 0.5, 0.0]], pressure=np.array([100.0, 300.0]))
    free = picture(renderer, data, look=Look("points", "pressure"))
    told = picture(renderer, data, look=Look("points", "pressure", data.value_range("pressure")))
    assert np.array_equal(free, told)
    assert data.value_range("pressure") == pytest.approx((102.0, 298.0))


def test_the_legend_shows_the_map_and_nothing_else_changes(renderer):
    image = picture(renderer, NOBODY, size=(320, 180)).astype(np.uint8)
    with_legend = add_legend(image, replace(POINTS, color_map="viridis"))
    difference = np.abs(with_legend.astype(int) - image).max(axis=2) > 0
    assert not difference[:140].any()
    assert not difference[:, 200:].any()
    row = with_legend[180 - round(1.3 * 5) - 2]
    bar = row[6 : 6 + 75].astype(float) / 255
    assert bar[1:-1] == pytest.approx(color_map_table("viridis", 75)[1:-1], abs=0.01)


def test_a_frame_may_grow_shrink_and_be_empty(renderer):
    many = frame(np.random.default_rng(1).uniform(-0.5, 0.5, (3000, 3)) + [0, 0.5, 0], radius=0.02)
    few = frame([[0.0, 0.5, 0.0]])
    first = picture(renderer, few)
    picture(renderer, many)
    assert np.array_equal(picture(renderer, few), first)
    empty = picture(renderer, NOBODY)
    assert changed(first, empty).any()


def test_a_picture_without_pixels_is_no_error(renderer):
    renderer.set_stage([], BOUNDS)
    renderer.set_frame(NOBODY)
    renderer.draw(FRONT, (0, 0), POINTS, target=None)


def test_samples_smooth_the_edges(renderer):
    ball = frame([[0.0, 0.5, 0.0]], speed=1.0, radius=0.3)
    hard, soft = (picture(renderer, ball, look=replace(POINTS, samples=count))[45] for count in (1, 16))
    steps = [np.abs(np.diff(row[:60], axis=0)).max() for row in (hard, soft)]
    assert steps[1] < 0.8 * steps[0]


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"style": "fluids"}, 'style: "fluids" is not one of points, fluid; did you mean fluid?'),
        ({"color_by": "sped"}, "did you mean speed?"),
        ({"color_map": "jet"}, "viridis, turbo"),
        ({"samples": 0}, "expected 1 or more"),
    ],
)
def test_a_look_that_cannot_be_is_refused(wrong, sentence):
    with pytest.raises(fontana.BadInput, match=sentence.replace("?", r"\?")):
        Look(**wrong)


def test_a_context_that_is_too_old_is_refused():
    class Old:
        version_code = 310

    with pytest.raises(fontana.DeviceUnavailable, match=r"OpenGL 3\.3; this context has 3\.1"):
        Renderer(Old())


def test_a_range_has_a_width_even_where_all_values_are_equal():
    data: FrameData = frame([[0, 0, 0], [1, 0, 0]], speed=0.0)
    assert data.value_range("speed") == (0.0, 1.0)
    assert NOBODY.value_range("density") == (0.0, 1.0)
