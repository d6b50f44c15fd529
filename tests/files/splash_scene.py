"""A scene of a moment: a cube of water falls on a floor while a jet comes from the side."""

FRAMES = 12
SPLASH = {
    "name": "splash",
    "fluid": {"particle_spacing": 0.05},
    "emitters": [
        {"type": "block", "centre": [0, 0.35, 0], "size": [0.4, 0.4, 0.4], "jitter": 0.1},
        {"type": "disc", "centre": [-0.8, 0.5, 0], "radius": 0.1, "direction": [1, 0.3, 0], "speed": 2.5},
    ],
    "colliders": [{"type": "plane_y"}],
    "output": {"frames": FRAMES},
}
