"""Colliders and light: what stands where, what hides what, where shadows fall."""

from __future__ import annotations

import numpy as np
import pytest
from scenery import ABOVE, BOUNDS, FRONT, POINTS, SIZE, changed, frame, picture

from fontana.gl.camera import Camera
from fontana.gl.lights import SUN
from fontana.gl.solids import make_solids

NOBODY = frame(np.zeros((0, 3)))
FLOOR = {"type": "plane_y"}


def seen(renderer, colliders, camera=FRONT, behind=()) -> np.ndarray:
    """Which pixels the colliders change."""
    return changed(picture(renderer, NOBODY, [*behind, *colliders], camera), picture(renderer, NOBODY, behind, camera))


@pytest.mark.parametrize(
    ("collider", "camera"),
    [
        ({"type": "plane_y", "centre": [0, 0.1, 0]}, FRONT),
        ({"type": "plane_y", "centre": [0, 0.9, 0], "flip": True}, Camera.looking([0, 0.2, 4], [0, 0.7, 0])),
        ({"type": "plane_x", "centre": [-0.5, 0, 0]}, FRONT),
        ({"type": "plane_z", "centre": [0, 0, -0.5]}, FRONT),
        ({"type": "sphere_outside", "centre": [0, 0.5, 0], "radius": 0.3}, FRONT),
        ({"type": "sphere_inside", "centre": [0, 0.5, 0], "radius": 0.3}, FRONT),
        ({"type": "cylinder_outside", "radius": 0.3, "cutoff": 0.5}, FRONT),
        ({"type": "cylinder_inside", "radius": 0.3, "cutoff": 0.5, "thickness": 0.1}, FRONT),
        ({"type": "cylinder_inside", "radius": 0.3, "cutoff": 0.5}, FRONT),
    ],
    ids=lambda value: value["type"] if isinstance(value, dict) else "",
)
def test_every_collider_is_seen_and_a_disabled_one_is_not(renderer, collider, camera):
    assert seen(renderer, [collider], camera).sum() > 50
    assert not seen(renderer, [collider | {"enabled": False}], camera).any()


def test_a_plane_is_not_seen_from_behind(renderer):
    """One looks into a box through its near wall."""
    assert not seen(renderer, [{"type": "plane_z", "centre": [0, 0, 0.5], "flip": True}]).any()


def test_a_rock_is_as_large_as_its_sphere(renderer):
    rock = {"type": "sphere_outside", "centre": [0.2, 0.6, 0.0], "radius": 0.3}
    columns = np.nonzero(seen(renderer, [rock]).any(axis=0))[0]
    scale = SIZE[1] / (2 * np.tan(np.radians(15)) * 4.0)
    assert columns.mean() + 0.5 == pytest.approx(60 + 0.2 * scale, abs=1.5)
    assert 0.90 * 0.6 * scale < np.ptp(columns) + 1 <= 0.6 * scale + 1.5


def test_colliders_follow_their_centres(renderer):
    rock = {"type": "sphere_outside", "radius": 0.2}
    places = []
    for x in (-0.4, 0.4):
        data = frame(np.zeros((0, 3)), centres=[np.array([x, 0.5, 0.0])])
        difference = changed(picture(renderer, data, [rock]), picture(renderer, NOBODY))
        places.append(np.nonzero(difference)[1].mean())
    assert places[0] < 50
    assert places[1] > 70


def test_a_collider_hides_what_is_behind_it_alone(renderer):
    rock = {"type": "sphere_outside", "centre": [0, 0.5, 0], "radius": 0.3}
    alone = picture(renderer, NOBODY, [rock])
    hidden, in_front = (picture(renderer, frame([[0, 0.5, z]], 1.0, 0.05), [rock]) for z in (-0.6, 0.6))
    assert not changed(alone, hidden).any()
    assert changed(alone, in_front).any()


def test_a_basin_has_a_rim_of_its_thickness_and_is_open(renderer):
    """From above: the rim is a ring, and a particle within is seen."""
    basin = {"type": "cylinder_inside", "radius": 0.4, "cutoff": 0.5, "thickness": 0.1}
    outline = make_solids([basin], BOUNDS)[0]
    away = np.linalg.norm(outline.position[:, [0, 2]], axis=1)
    top = outline.position[:, 1] > 0.5 - 1e-9
    assert away.max() == pytest.approx(0.5)
    assert away[top].min() > 0.4
    assert outline.position[:, 1].max() == pytest.approx(0.5)
    alone = picture(renderer, NOBODY, [basin], ABOVE)
    filled = picture(renderer, frame([[0, 0.1, 0]], 1.0), [basin], ABOVE)
    assert changed(alone, filled).sum() > 20


def test_two_faces_of_a_wall_are_one_wall():
    inside = {"type": "cylinder_inside", "radius": 0.36, "cutoff": 0.3, "thickness": 0.03}
    outside = {"type": "cylinder_outside", "radius": 0.42, "cutoff": 0.3, "thickness": 0.03}
    solids = make_solids([FLOOR, inside, outside], BOUNDS)
    assert [solid.material for solid in solids] == ["ground", "stone"]
    away = np.linalg.norm(solids[1].position[:, [0, 2]], axis=1)
    assert away.max() == pytest.approx(0.42)
    apart = make_solids([FLOOR, inside, outside | {"cutoff": 0.2}], BOUNDS)
    assert len(apart) == 3


def test_triangles_face_the_way_their_normals_say():
    colliders = [
        FLOOR,
        {"type": "plane_x", "flip": True},
        {"type": "sphere_outside", "radius": 0.2},
        {"type": "sphere_inside", "radius": 0.2},
        {"type": "cylinder_inside", "radius": 0.3, "cutoff": 0.5, "thickness": 0.1},
        {"type": "cylinder_inside", "radius": 0.3},
        {"type": "cylinder_outside", "radius": 0.3, "cutoff": 0.5},
    ]
    for solid in make_solids(colliders, BOUNDS):
        a, b, c = solid.position.reshape(-1, 3, 3).transpose(1, 0, 2)
        face = np.cross(b - a, c - a)
        area = np.linalg.norm(face, axis=1)
        real = area > 1e-9 * area.max()  # at a pole two corners are one
        facing = np.sum(face * solid.normal.reshape(-1, 3, 3).mean(axis=1), axis=1)
        assert (facing[real] > 0).all(), solid.material


def test_a_shadow_falls_away_from_the_sun(renderer):
    floor = picture(renderer, NOBODY, [FLOOR], ABOVE)
    rock = {"type": "sphere_outside", "centre": [0, 0.6, 0], "radius": 0.15}
    shaded = picture(renderer, NOBODY, [FLOOR, rock], ABOVE)
    foot = np.array([[0.0, 0.6, 0.0]]) - SUN * 0.6 / SUN[1]
    x, y = ABOVE.project(foot, SIZE)[0][0].astype(int)
    assert shaded[y, x].sum() < 0.6 * floor[y, x].sum()
    mirrored = SIZE[0] - 1 - x
    assert shaded[y, mirrored].sum() > 0.85 * floor[y, mirrored].sum()


def test_points_throw_shadows_too(renderer):
    data = frame([[0.0, 0.6, 0.0]], radius=0.15)
    floor, shaded = picture(renderer, NOBODY, [FLOOR], ABOVE), picture(renderer, data, [FLOOR], ABOVE, POINTS)
    foot = np.array([[0.0, 0.6, 0.0]]) - SUN * 0.6 / SUN[1]
    x, y = ABOVE.project(foot, SIZE)[0][0].astype(int)
    assert shaded[y, x].sum() < 0.6 * floor[y, x].sum()
