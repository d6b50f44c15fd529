"""The camera's mathematics, against what it says of itself and against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

import fontana
from fontana.gl.camera import Camera

SIZE = (160, 90)
POINTS = np.array([[0.2, 0.1, -0.3], [-0.5, 0.4, 0.2], [0.0, 0.0, 0.0]])


def through_matrices(camera: Camera, points: np.ndarray, shift=(0.0, 0.0)) -> np.ndarray:
    """Pixels from the upper left corner by way of OpenGL's clip space."""
    matrix = camera.projection_matrix(SIZE, shift) @ camera.view_matrix()
    clip = np.concatenate([points, np.ones((len(points), 1))], axis=1) @ matrix.T
    ndc = clip[:, :3] / clip[:, 3:]
    assert (np.abs(ndc[:, 2]) < 1).all()
    return (ndc[:, :2] * [0.5, -0.5] + 0.5) * SIZE


def test_eye_and_target_come_back():
    camera = Camera.looking([1.0, 2.0, -3.0], [0.5, 0.2, 0.1], 40.0)
    assert camera.eye == pytest.approx([1.0, 2.0, -3.0])
    pixels, depth = camera.project(np.array([[0.5, 0.2, 0.1]]), SIZE)
    assert pixels[0] == pytest.approx([80, 45])
    assert depth[0] == pytest.approx(camera.distance)


def test_axes_are_a_right_handed_frame_with_y_up():
    camera = Camera(azimuth=130.0, elevation=-35.0)
    axes = np.stack([camera.right, camera.up, camera.backward])
    assert axes @ axes.T == pytest.approx(np.eye(3))
    assert np.linalg.det(axes) == pytest.approx(1.0)
    assert camera.up[1] > 0
    assert camera.right[1] == pytest.approx(0.0)


def test_projection_and_matrices_agree():
    camera = Camera.looking([1.0, 0.8, 2.0], [0.0, 0.1, 0.0], 50.0)
    assert through_matrices(camera, POINTS) == pytest.approx(camera.project(POINTS, SIZE)[0])


def test_a_shift_moves_the_picture_by_that_many_pixels():
    camera = Camera()
    moved = through_matrices(camera, POINTS, (0.25, -0.4)) - through_matrices(camera, POINTS)
    assert moved == pytest.approx(np.tile([0.25, 0.4], (3, 1)), abs=1e-6)


def test_a_ray_goes_through_what_projects_to_its_pixel():
    camera = Camera.looking([1.0, 0.8, 2.0], [0.0, 0.1, 0.0], 50.0)
    for point, pixel in zip(POINTS, camera.project(POINTS, SIZE)[0], strict=True):
        origin, direction = camera.ray(pixel, SIZE)
        assert np.cross(direction, point - origin) == pytest.approx(np.zeros(3), abs=1e-9)
        assert direction @ (point - origin) > 0


@pytest.mark.parametrize("aspect", [0.4, 1.0, 2.5])
def test_frame_all_shows_all_and_fills_the_picture(aspect: float):
    bounds = np.array([[-1.0, 0.2, -0.5], [2.0, 1.0, 0.7]])
    camera = Camera(azimuth=40.0, elevation=30.0)
    camera.frame_all(bounds, aspect)
    corners = np.array([[x, y, z] for x in bounds[:, 0] for y in bounds[:, 1] for z in bounds[:, 2]])
    size = (int(1000 * aspect), 1000)
    share = np.abs(camera.project(corners, size)[0] / size - 0.5).max()
    assert 0.4 < share < 0.5


def test_pan_moves_by_shares_of_the_height():
    camera = Camera(target=np.array([0.1, 0.2, 0.3]))
    before = camera.project(camera.target[None], SIZE)[0][0]
    point = camera.target.copy()
    camera.pan(0.5, 0.25)
    after = camera.project(point[None], SIZE)[0][0]
    assert after - before == pytest.approx([-45.0, 22.5])


def test_orbit_keeps_the_distance_and_stops_before_the_pole():
    camera = Camera(distance=2.0)
    camera.orbit(400.0, 500.0)
    assert np.linalg.norm(camera.eye - camera.target) == pytest.approx(2.0)
    assert camera.elevation == 89.0
    assert 0 <= camera.azimuth < 360
    camera.zoom(0.5)
    assert camera.distance == pytest.approx(1.0)


def test_the_view_of_a_scene_wins_over_what_would_show_the_whole():
    bounds = np.array([[-1.0, 0.0, -1.0], [1.0, 1.0, 1.0]])
    camera = Camera.of_scene({"eye": [0, 1, 4], "target": [0, 0.5, 0], "field_of_view": 20}, bounds)
    assert camera.eye == pytest.approx([0, 1, 4])
    assert camera.field_of_view == 20
    whole = Camera.of_scene({}, bounds)
    inside = whole.project(np.array([[-1.0, 0.0, -1.0], [1.0, 1.0, 1.0]]), (300, 200))[0]
    assert (inside > 0).all()
    assert (inside < [300, 200]).all()


def test_looking_from_the_target_is_refused():
    with pytest.raises(fontana.BadInput, match="same place"):
        Camera.looking([1, 2, 3], [1, 2, 3])
