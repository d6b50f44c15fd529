"""The averages that become the grid `vel`; the files themselves are read in test_blender.py."""

from __future__ import annotations

import numpy as np

from fontana.export.vdb import splat


def test_a_constant_velocity_stays_constant() -> None:
    places = np.random.default_rng(1).uniform(-5, 9, (500, 3))
    coordinates, averages = splat(places, np.tile([[1.0, -2.0, 3.0]], (500, 1)))
    assert np.allclose(averages[np.abs(averages).sum(axis=1) > 0], [1, -2, 3])
    assert len(np.unique(coordinates, axis=0)) == len(coordinates)
    assert coordinates.min() >= -7 and coordinates.max() <= 11


def test_averages_equal_the_sum_over_all_particles() -> None:
    generator = np.random.default_rng(2)
    places, values = generator.uniform(0, 4, (60, 3)), generator.normal(size=(60, 3))
    coordinates, averages = splat(places, values)
    for coordinate, average in zip(coordinates, averages, strict=True):
        distance = np.abs(places - coordinate)
        inner, outer = 0.75 - distance**2, 0.5 * (1.5 - distance) ** 2
        weight = np.where(distance < 0.5, inner, np.where(distance < 1.5, outer, 0)).prod(axis=1)
        if weight.sum() > 1e-9:
            assert np.allclose(average, weight @ values / weight.sum(), atol=1e-9)


def test_a_lone_particle_far_away_costs_nothing() -> None:
    coordinates, _ = splat(np.array([[0.0, 0, 0], [4e5, 4e5, 4e5]]), np.ones((2, 3)))
    assert len(coordinates) == 54
