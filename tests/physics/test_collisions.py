"""One particle against each surface, compared with the closed form: position on the surface, restitution, friction."""

import numpy as np
import pytest

ELASTICITY, FRICTION = 0.6, 0.25
SURFACES = {
    # name: (type, fields, start, velocity); each start flies into the surface.
    "plane_x": ("plane_x", {}, (0.05, 1.0, 2.0), (-3.0, 0.4, 0.3)),
    "plane_y": ("plane_y", {}, (1.0, 0.05, 2.0), (0.4, -3.0, 0.3)),
    "plane_z": ("plane_z", {}, (1.0, 2.0, 0.05), (0.4, 0.3, -3.0)),
    "flipped plane": ("plane_x", {"flip": True, "centre": (1.0, 0.0, 0.0)}, (0.95, 1.0, 2.0), (3.0, 0.4, 0.3)),
    "sphere_inside": ("sphere_inside", {"radius": 1.0}, (0.9, 0.1, 0.2), (4.0, 1.0, 0.0)),
    "sphere_outside": ("sphere_outside", {"radius": 1.0}, (1.05, 0.1, 0.1), (-4.0, 1.0, 0.0)),
    "cylinder_inside": ("cylinder_inside", {"radius": 1.0}, (0.9, 7.0, 0.2), (4.0, 1.0, 0.5)),
    "cylinder_outside": ("cylinder_outside", {"radius": 1.0}, (1.05, 7.0, 0.1), (-4.0, 1.0, 0.5)),
}
DT = 0.05


def normal_at(kind, fields, x):
    """Unit normal into the fluid at `x`, and how far `x` is behind the surface."""
    offset = x - np.array(fields.get("centre", (0.0, 0.0, 0.0)))
    if kind.startswith("plane"):
        normal = np.eye(3)["xyz".index(kind[-1])] * (-1.0 if fields.get("flip") else 1.0)
        return normal, -offset @ normal
    if kind.startswith("cylinder"):
        offset[1] = 0.0
    distance = np.linalg.norm(offset)
    inside = 1.0 if kind.endswith("inside") else -1.0
    return -inside * offset / distance, inside * (distance - fields["radius"])


def closed_form(kind, fields, start, velocity):
    x, v = np.array(start) + DT * np.array(velocity), np.array(velocity)
    normal, depth = normal_at(kind, fields, x)
    assert depth > 0.0, "the case does not hit"
    v_normal = (v @ normal) * normal
    return x + depth * normal, (1.0 - FRICTION) * (v - v_normal) - ELASTICITY * v_normal


def fly(make_simulation, backend, start, velocity, colliders, dt=DT):
    simulation = make_simulation(
        backend, forces__gravity=(0, 0, 0), fluid__viscosity=0.0, time__timestep=dt, time__substeps=1
    )
    # Steps this long are unstable for a fluid; one particle has no neighbours and does not care.
    simulation.set("fluid.pressure_constant", 0.0)
    for kind, fields in colliders:
        simulation.add_collider(kind, **{"elasticity": ELASTICITY, "friction": FRICTION} | fields)
    simulation.add_particles(np.array([start], dtype=np.float32), np.array([velocity], dtype=np.float32))
    simulation.step_frame()
    return simulation.read("position")[0], simulation.read("velocity")[0]


@pytest.mark.parametrize("case", SURFACES)
def test_response_matches_the_closed_form(backend, make_simulation, case):
    kind, fields, start, velocity = SURFACES[case]
    expected_x, expected_v = closed_form(kind, dict(fields), start, velocity)
    x, v = fly(make_simulation, backend, start, velocity, [(kind, fields)])
    assert x == pytest.approx(expected_x, abs=1e-5)
    assert v == pytest.approx(expected_v, abs=1e-5)


@pytest.mark.parametrize("case", SURFACES)
def test_nothing_happens_away_from_the_surface(backend, make_simulation, case):
    kind, fields, start, velocity = SURFACES[case]
    away = -np.array(velocity)
    x, v = fly(make_simulation, backend, start, away, [(kind, fields)])
    assert v == pytest.approx(away, abs=1e-6)
    assert x == pytest.approx(np.array(start) + DT * away, abs=1e-5)


def test_a_fast_particle_does_not_tunnel(backend, make_simulation):
    """A kilometre a second: 50 m behind the plane in one substep, and yet back on it."""
    x, v = fly(make_simulation, backend, (0.0, 0.01, 0.0), (0.0, -1000.0, 0.0), [("plane_y", {})])
    assert x[1] == 0.0
    assert v[1] == pytest.approx(1000.0 * ELASTICITY)


def test_a_cylinder_ends_at_its_cutoff(backend, make_simulation):
    wall = [("cylinder_inside", {"radius": 1.0, "cutoff": 0.5})]
    _, above = fly(make_simulation, backend, (0.95, 0.6, 0.0), (4.0, 0.0, 0.0), wall)
    assert above[0] == pytest.approx(4.0)
    _, below = fly(make_simulation, backend, (0.95, 0.3, 0.0), (4.0, 0.0, 0.0), wall)
    assert below[0] == pytest.approx(-4.0 * ELASTICITY)


def test_a_wall_of_finite_thickness_leaves_the_far_side_alone(backend, make_simulation):
    wall = [("cylinder_inside", {"radius": 1.0, "cutoff": 0.5, "thickness": 0.05})]
    x, v = fly(make_simulation, backend, (1.5, 0.2, 0.0), (-1.0, 0.0, 0.0), wall)
    assert (x[0], v[0]) == (pytest.approx(1.45), pytest.approx(-1.0))


def test_water_can_stand_on_the_rim(backend, make_simulation):
    """A particle that sinks a little into the top of a solid cylinder is lifted back onto it."""
    pillar = [("cylinder_outside", {"radius": 1.0, "cutoff": 0.5})]
    x, v = fly(make_simulation, backend, (0.2, 0.51, 0.0), (0.0, -1.0, 0.0), pillar)
    assert x[1] == pytest.approx(0.5, abs=1e-6)
    assert v[1] == pytest.approx(ELASTICITY, abs=1e-6)


def test_a_moving_surface_pushes(backend, make_simulation):
    """An elastic ball that meets a resting particle at 2 m/s sends it off at (1 + e) times that."""
    ball = [("sphere_outside", {"radius": 1.0, "velocity": (2.0, 0.0, 0.0), "friction": 0.0})]
    x, v = fly(make_simulation, backend, (1.05, 0.0, 0.0), (0.0, 0.0, 0.0), ball)
    assert v[0] == pytest.approx(2.0 * (1.0 + ELASTICITY), rel=1e-5)
    assert x[0] == pytest.approx(1.1, rel=1e-5)


def test_keys_move_the_centre_linearly_and_hold_outside(make_simulation):
    simulation = make_simulation()
    index = simulation.add_collider("sphere_outside", radius=0.2)
    simulation.set_collider_keys(index, [1.0, 2.0, 4.0], [(0, 3, 0), (0, 1, 0), (2, 1, 0)])
    centres = [simulation.collider_centre(index, t) for t in (0.0, 1.5, 3.0, 9.0)]
    assert centres == [(0, 3, 0), (0, 2, 0), (1, 1, 0), (2, 1, 0)] or centres == [
        [0, 3, 0],
        [0, 2, 0],
        [1, 1, 0],
        [2, 1, 0],
    ]
    with pytest.raises(Exception, match="ascend"):
        simulation.set_collider_keys(index, [1.0, 1.0], [(0, 0, 0), (1, 0, 0)])


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        ({"radius": -1.0}, "radius must be above 0"),
        ({"elasticity": 1.5}, "elasticity must be 0 to 1"),
        ({"friction": float("nan")}, "friction must be 0 to 1"),
        ({"thickness": 0.0}, "thickness must be above 0"),
        ({"radios": 1.0}, "no field 'radios'"),
    ],
)
def test_bad_surfaces_are_refused(make_simulation, fields, sentence):
    with pytest.raises(Exception, match=sentence):
        make_simulation().add_collider("sphere_outside", **fields)
