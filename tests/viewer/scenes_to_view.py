"""The scene that the tests of the viewer look at: 216 particles that run in a moment."""

DROP = {
    "name": "drop",
    "fluid": {"particle_spacing": 0.05, "viscosity": 5},
    "time": {"max_substeps": 2000},
    "emitters": [{"type": "block", "centre": [0, 0.3, 0], "size": [0.3, 0.3, 0.3], "jitter": 0.1}],
    "colliders": [
        {"type": "plane_y"},
        {"type": "sphere_outside", "radius": 0.1, "keys": [{"frame": 0, "centre": [0.3, 0.1, 0]}]},
    ],
    "output": {"frames": 6},
}
