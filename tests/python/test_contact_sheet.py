"""The contact sheet, and the small renderer behind it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib import image as images

import fontana as package
from fontana.contact_sheet import contact_sheet
from fontana.contact_sheet.raycast import cast
from fontana.contact_sheet.spheres import Stage, View, splat

BOUNDS = np.array([[-2.0, 0.0, -2.0], [2.0, 2.0, 2.0]])


@pytest.fixture(params=[40.0, 0.0], ids=["perspective", "parallel"])
def view(request) -> View:
    """From 5 m in front of the origin, 1 m up."""
    return View(np.array([0.0, 1.0, 5.0]), np.array([0.0, 1.0, 0.0]), request.param, (80, 60), height=3.0)


def test_rays_go_through_what_projects_to_their_pixel(view: View) -> None:
    points = np.array([[0.3, 1.2, 0.5], [-0.7, 0.4, -1.0]])
    pixels, depth, _ = view.project(points)
    origin, direction = view.rays()
    for point, pixel, far in zip(points, pixels, depth, strict=True):
        x, y = pixel.astype(int)
        reached = origin[y, x] + far * direction[y, x]
        assert np.abs(reached - point).max() < 0.06  # half a pixel at that distance


def test_the_nearer_sphere_wins(view: View) -> None:
    points = np.array([[0.0, 1.0, 0.0], [0.0, 1.0, 2.0], [0.0, 1.0, -3.0]])
    depth, winner, normal = splat(view, points, 0.2)
    assert winner[30, 40] == 1
    assert depth[30, 40] == pytest.approx(2.8, abs=0.01)
    assert normal[30, 40] == pytest.approx([0, 0, 1], abs=0.25)
    assert winner[0, 0] == -1
    assert np.isinf(depth[0, 0])


def at_middle(collider: dict, eye: list[float], target: list[float], others: tuple[dict, ...] = ()) -> tuple:
    """Distance and normal that the middle ray of a camera meets."""
    camera = View(np.array(eye, dtype=float), np.array(target, dtype=float), 30.0, (3, 3))
    colliders = [collider, *others]
    centres = [np.array(c.get("centre", [0.0, 0.0, 0.0]), dtype=float) for c in colliders]
    hits = cast(colliders, centres, camera.rays(), BOUNDS, range(len(colliders)))
    return hits.distance[1, 1], hits.normal[1, 1]


@pytest.mark.parametrize(
    ("collider", "eye", "target", "distance", "normal"),
    [
        ({"type": "sphere_outside", "radius": 0.5}, [0, 0, 3], [0, 0, 0], 2.5, [0, 0, 1]),
        ({"type": "sphere_inside", "radius": 0.5}, [0, 0, 3], [0, 0, 0], 3.5, [0, 0, 1]),
        ({"type": "plane_y"}, [0, 2, 0], [0, 0, 0], 2.0, [0, 1, 0]),
        ({"type": "plane_y", "flip": True}, [0, 2, 0], [0, 0, 0], np.inf, [0, 0, 0]),
        ({"type": "plane_z", "centre": [0, 0, -1]}, [0, 1, 3], [0, 1, 0], 4.0, [0, 0, 1]),
        ({"type": "cylinder_outside", "radius": 0.5}, [0, 1, 3], [0, 1, 0], 2.5, [0, 0, 1]),
        ({"type": "cylinder_inside", "radius": 0.5}, [0, 1, 3], [0, 1, 0], 3.5, [0, 0, 1]),
        ({"type": "cylinder_inside", "radius": 0.5, "thickness": 0.1}, [0, 1, 3], [0, 1, 0], 2.4, [0, 0, 1]),
        ({"type": "cylinder_inside", "radius": 0.5, "cutoff": 0.9}, [0, 1, 3], [0, 1, 0], np.inf, [0, 0, 0]),
        (
            {"type": "cylinder_inside", "radius": 0.5, "cutoff": 0.5, "thickness": 0.2},
            [0, 2, 0.6],
            [0, 0, 0.6],
            1.5,
            [0, 1, 0],
        ),
        ({"type": "sphere_outside", "radius": 0.5, "enabled": False}, [0, 0, 3], [0, 0, 0], np.inf, [0, 0, 0]),
    ],
)
def test_rays_meet_colliders(collider: dict, eye, target, distance: float, normal) -> None:
    got, facing = at_middle(collider, eye, target)
    assert got == pytest.approx(distance)
    assert facing == pytest.approx(normal)


def test_a_floor_ends_at_the_walls_of_the_box() -> None:
    floor, wall = {"type": "plane_y"}, {"type": "plane_x", "centre": [1.0, 0.0, 0.0], "flip": True}
    assert at_middle(floor, [0.5, 2, 0], [0.5, 0, 0], (wall,))[0] == pytest.approx(2)
    assert np.isinf(at_middle(floor, [1.5, 2, 0], [1.5, 0, 0], (wall,))[0])


def test_a_sphere_shades_the_floor_and_the_fluid_shows_its_speed() -> None:
    camera = View(np.array([0.0, 3.0, 4.0]), np.array([0.0, 0.5, 0.0]), 40.0, (120, 90))
    stage = Stage(camera, [{"type": "plane_y"}], [np.zeros(3)], BOUNDS)

    def draw(points: np.ndarray, speed: float) -> np.ndarray:
        return stage.draw([np.zeros(3)], points, np.full(len(points), speed), 0.3, 1.0)

    nothing = draw(np.zeros((0, 3)), 0.0)
    slow, fast = (draw(np.array([[0.0, 1.0, 0.0]]), speed) for speed in (0.0, 1.0))
    ball = (slow != fast).any(axis=2)
    assert 200 < ball.sum() < 4000
    assert fast[ball].mean() > 2 * slow[ball].mean()
    darker = (slow.sum(axis=2) < 0.8 * nothing.sum(axis=2)) & ~ball
    assert darker.sum() > 100


def test_a_run_is_drawn_frame_by_frame(fontana, drop_file: Path, tmp_path: Path) -> None:
    fontana("run", drop_file, "--out", "out", "--frames", 2, "--no-picture", "--quiet")
    path = contact_sheet(tmp_path / "out")
    sheet = images.imread(path)
    assert sheet.shape[0] > 440
    assert sheet.shape[1] > 2 * 640
    panels = [sheet[70:490, left : left + 640] for left in (6, 652)]
    assert all(panel.std() > 0.02 for panel in panels)
    assert np.abs(panels[0] - panels[1]).max() > 0.2


def test_no_run_no_picture(tmp_path: Path) -> None:
    with pytest.raises(package.BadInput, match="not the folder of a run"):
        contact_sheet(tmp_path)
