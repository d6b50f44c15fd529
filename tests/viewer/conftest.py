"""What the tests of the viewer share."""

from __future__ import annotations

import pytest

from fontana.viewer.player import CachePlayer


@pytest.fixture
def play():
    """Makes players of a folder that begin paused, and ends them."""
    made = []

    def make(folder):
        made.append(CachePlayer(folder, is_playing=False))
        return made[-1]

    yield make
    for player in made:
        player.close()
