"""Running a scene into a folder: frames, checkpoints, a manifest, and how to continue after a stop."""
