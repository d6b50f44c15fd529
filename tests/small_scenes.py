"""Scenes that run in a moment."""

# 216 particles fall onto a floor beside a ball that keys hold.
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

# A cube of water falls on a floor while a jet comes from the side.
SPLASH = {
    "name": "splash",
    "fluid": {"method": "mueller", "particle_spacing": 0.05},
    "emitters": [
        {"type": "block", "centre": [0, 0.35, 0], "size": [0.4, 0.4, 0.4], "jitter": 0.1},
        {"type": "disc", "centre": [-0.8, 0.5, 0], "radius": 0.1, "direction": [1, 0.3, 0], "speed": 2.5},
    ],
    "colliders": [{"type": "plane_y"}],
    "output": {"frames": 12},
}
SPLASH_FRAMES = SPLASH["output"]["frames"]
