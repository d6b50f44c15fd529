"""A small renderer for contact sheets: particles as lit spheres among ray-cast colliders, with shadows.

Own code, because the plots of matplotlib sort whole artists by depth: a splash in front of, in and behind a basin needs
a depth for each pixel. numpy is all it takes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fontana.contact_sheet.raycast import Hits, cast

LIGHT = np.array([0.45, 1.0, 0.35]) / np.linalg.norm([0.45, 1.0, 0.35])
BACKGROUND = np.array([[0.055, 0.065, 0.085], [0.018, 0.022, 0.03]])  # bottom, top
STONE = np.array([0.46, 0.43, 0.40])
ROCK = np.array([0.34, 0.27, 0.22])
FLOOR = np.array([0.16, 0.18, 0.21])
SPEED_COLOURS = np.array(
    [[0.02, 0.16, 0.42], [0.04, 0.36, 0.72], [0.25, 0.66, 0.93], [0.80, 0.94, 1.0], [1.0, 1.0, 1.0]]
)
SPEED_STOPS = np.array([0.0, 0.25, 0.55, 0.85, 1.0])
SHADOW_SIZE = 512


@dataclass
class View:
    """A camera: `eye` and `target` in metres, the vertical `field_of_view` in degrees; 0 is a parallel projection that
    is `height` metres high."""

    eye: np.ndarray
    target: np.ndarray
    field_of_view: float
    size: tuple[int, int]  # pixels: width, height
    height: float = 0.0

    def __post_init__(self) -> None:
        forward = self.target - self.eye
        self.forward = forward / np.linalg.norm(forward)
        up = np.array([0.0, 1.0, 0.0]) if abs(self.forward[1]) < 0.999 else np.array([0.0, 0.0, 1.0])
        right = np.cross(self.forward, up)
        self.right = right / np.linalg.norm(right)
        self.up = np.cross(self.right, self.forward)

    @property
    def _pixels_per_unit(self) -> float:
        """Pixels of a metre: everywhere in a parallel projection, at a depth of 1 m in a perspective one."""
        if self.field_of_view:
            return self.size[1] / (2 * np.tan(np.radians(self.field_of_view) / 2))
        return self.size[1] / self.height

    def project(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Pixel coordinates (N, 2), depth along the view (N,) in metres, and pixels of a metre there (N,)."""
        relative = points - self.eye
        depth = relative @ self.forward
        scale = np.full(depth.shape, self._pixels_per_unit)
        if self.field_of_view:
            scale = scale / np.maximum(depth, 1e-6)
        pixels = np.stack([relative @ self.right, -(relative @ self.up)], axis=-1) * scale[..., None]
        return pixels + 0.5 * np.array(self.size), depth, scale

    def rays(self) -> tuple[np.ndarray, np.ndarray]:
        """Origins and directions, (height, width, 3). A ray's distance is its depth: directions have depth 1."""
        width, height = self.size
        x = (np.arange(width) + 0.5 - 0.5 * width) / self._pixels_per_unit
        y = (0.5 * height - np.arange(height) - 0.5) / self._pixels_per_unit
        across = x[None, :, None] * self.right + y[:, None, None] * self.up
        if self.field_of_view:
            return np.broadcast_to(self.eye, across.shape), across + self.forward
        return across + self.eye, np.broadcast_to(self.forward, across.shape)


def splat(view: View, points: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Draws spheres into a depth buffer.

    Returns depth (height, width; inf where nothing is), which sphere is there (-1: none), and its normal.
    """
    width, height = view.size
    pixels, depth, scale = view.project(points)
    depth_buffer = np.full(width * height, np.inf)
    winner = np.full(width * height, -1)
    normal = np.zeros((width * height, 3))
    pixel_radius = np.clip(radius * scale, 0.7, 40.0)
    # Few classes of size, each drawn offset by offset for all its spheres: powers of the root of two.
    reach = np.ceil(2 ** (0.5 * np.ceil(2 * np.log2(pixel_radius)))).astype(int)
    for size in np.unique(reach):
        chosen = np.flatnonzero((reach == size) & (depth > radius))
        for dy in range(-size, size + 1):
            for dx in range(-size, size + 1):
                _splat_offset((dx, dy), chosen, pixels, depth, pixel_radius, radius, view, depth_buffer, winner, normal)
    shape = (height, width)
    return depth_buffer.reshape(shape), winner.reshape(shape), normal.reshape(*shape, 3)


def _splat_offset(offset, chosen, pixels, depth, pixel_radius, radius, view, depth_buffer, winner, normal) -> None:
    """Draws the pixel at `offset` from the middle of each chosen sphere."""
    width, height = view.size
    cell = np.floor(pixels[chosen]).astype(int) + offset
    away = (cell + 0.5 - pixels[chosen]) / pixel_radius[chosen, None]
    squared = np.sum(away**2, axis=1)
    kept = (squared < 1) & (cell >= 0).all(axis=1) & (cell[:, 0] < width) & (cell[:, 1] < height)
    chosen, cell, away = chosen[kept], cell[kept], away[kept]
    bulge = np.sqrt(1 - squared[kept])
    front = depth[chosen] - radius * bulge
    place = cell[:, 1] * width + cell[:, 0]
    np.minimum.at(depth_buffer, place, front)
    nearest = front == depth_buffer[place]
    place, away, bulge = place[nearest], away[nearest], bulge[nearest]
    winner[place] = chosen[nearest]
    normal[place] = away[:, :1] * view.right - away[:, 1:] * view.up - bulge[:, None] * view.forward


class Stage:
    """The colliders of a scene as a view and the light see them. What stands still is cast once for all frames.

    bounds is (2, 3) metres: surfaces without an end are drawn within it.
    """

    def __init__(self, view: View, colliders: list[dict], centres: list[np.ndarray], bounds: np.ndarray):
        self.view, self.colliders, self.bounds = view, colliders, bounds
        reach = 1.1 * float(np.linalg.norm(np.ptp(bounds, axis=0)))
        middle = bounds.mean(axis=0)
        self._light = View(middle + LIGHT * reach, middle, 0.0, (SHADOW_SIZE, SHADOW_SIZE), height=reach)
        moving = {k for k, collider in enumerate(colliders) if "keys" in collider or any(collider.get("velocity", ()))}
        casting = {k for k, collider in enumerate(colliders) if not collider["type"].startswith("plane")}
        everything = set(range(len(colliders)))
        self._moving, self._moving_casting = sorted(moving), sorted(moving & casting)
        self._still = cast(colliders, centres, view.rays(), bounds, sorted(everything - moving))
        self._still_lit = cast(colliders, centres, self._light.rays(), bounds, sorted(casting - moving))

    def draw(
        self, centres: list[np.ndarray], points: np.ndarray, speed: np.ndarray, radius: float, fast: float
    ) -> np.ndarray:
        """An image (height, width, 3) in 0 to 1 of particles (N, 3) with their speed (N,).

        `centres` are where the colliders are now, `radius` (m) is that of a particle, `fast` (m/s) is drawn white.
        """
        points = np.asarray(points, dtype=float)
        origin, direction = self.view.rays()
        hits = cast(self.colliders, centres, (origin, direction), self.bounds, self._moving, self._still)
        depth, winner, normal = splat(self.view, points, radius)
        fluid = depth < hits.distance
        depth = np.where(fluid, depth, hits.distance)
        normal = np.where(fluid[..., None], normal, hits.normal)
        seen = np.isfinite(depth)
        place = origin + np.where(seen, depth, 0.0)[..., None] * direction
        surface = self._surface_colour(hits, place, centres)
        albedo = np.where(fluid[..., None], _fluid_colour(winner, speed, fast), surface)
        lit = self._lit(place, normal, centres, points, radius)
        image = _shade(albedo, normal, direction, lit, fluid)
        height = np.linspace(1, 0, self.view.size[1])[:, None, None]
        background = np.broadcast_to((1 - height) * BACKGROUND[0] + height * BACKGROUND[1], image.shape)
        fade = np.where(fluid, 1.0, self._floor_fade(place, hits))[..., None]
        return np.clip(np.where(seen[..., None], fade * image + (1 - fade) * background, background), 0, 1)

    def _surface_colour(self, hits: Hits, place: np.ndarray, centres: list[np.ndarray]) -> np.ndarray:
        colour = np.zeros((*hits.index.shape, 3))
        for index, collider in enumerate(self.colliders):
            on = hits.index == index
            if collider["type"].startswith("plane"):
                colour[on] = FLOOR * _tiles(place[on], hits.normal[on], self._tile_size())[:, None]
            elif collider["type"].startswith("sphere"):
                colour[on] = ROCK * _mottle(place[on] - centres[index], collider["radius"])[:, None]
            else:
                colour[on] = STONE
        return colour

    def _tile_size(self) -> float:
        return float(np.ptp(self.bounds, axis=0).max()) / 12

    def _floor_fade(self, place: np.ndarray, hits: Hits) -> np.ndarray:
        """Planes end softly at the bounds; other surfaces do not fade."""
        middle, half = self.bounds.mean(axis=0), np.ptp(self.bounds, axis=0) / 2
        away = np.linalg.norm((place - middle)[..., [0, 2]], axis=-1) / max(half[0], half[2])
        is_floor = np.zeros(hits.index.shape, bool)
        for index, collider in enumerate(self.colliders):
            if collider["type"] == "plane_y":
                is_floor |= hits.index == index
        return np.where(is_floor, np.clip(2.2 * (1 - away), 0, 1), 1.0)

    def _lit(
        self, place: np.ndarray, normal: np.ndarray, centres: list[np.ndarray], points: np.ndarray, radius: float
    ) -> np.ndarray:
        """How much of the light arrives, 0 to 1: the depth map as the light sees it, asked around each place."""
        light = self._light
        hits = cast(self.colliders, centres, light.rays(), self.bounds, self._moving_casting, self._still_lit)
        depth = np.minimum(hits.distance, splat(light, points, radius)[0])
        texel = light.height / SHADOW_SIZE
        pixels, far, _ = light.project(place + normal * (2 * texel + radius))
        lit = np.zeros(place.shape[:-1])
        offsets = [(x, y) for x in (-1.2, 0, 1.2) for y in (-1.2, 0, 1.2)]
        for offset in offsets:
            cell = np.clip((pixels + offset).astype(int), 0, SHADOW_SIZE - 1)
            lit += far < depth[cell[..., 1], cell[..., 0]] + texel
        return lit / len(offsets)


def _fluid_colour(winner: np.ndarray, speed: np.ndarray, fast: float) -> np.ndarray:
    if not len(speed):
        return np.zeros((*winner.shape, 3))
    share = np.clip(speed / max(fast, 1e-9), 0, 1)
    colours = np.stack([np.interp(share, SPEED_STOPS, SPEED_COLOURS[:, k]) for k in range(3)], axis=1)
    return colours[winner]


def _shade(
    albedo: np.ndarray, normal: np.ndarray, direction: np.ndarray, lit: np.ndarray, fluid: np.ndarray
) -> np.ndarray:
    """Lambert's light with a sky above, a highlight and a bright edge on the fluid."""
    facing = -direction / np.linalg.norm(direction, axis=-1, keepdims=True)
    lambert = np.clip(normal @ LIGHT, 0, 1) * lit
    sky = 0.5 + 0.5 * normal[..., 1]
    image = albedo * (1.1 * lambert + 0.2 + 0.36 * sky)[..., None]
    halfway = facing + LIGHT
    halfway = halfway / np.linalg.norm(halfway, axis=-1, keepdims=True)
    highlight = np.clip(np.sum(normal * halfway, axis=-1), 0, 1) ** 40 * lit
    edge = (1 - np.clip(np.sum(normal * facing, axis=-1), 0, 1)) ** 3
    image = image + (fluid * 0.35 * highlight)[..., None]
    return image + (fluid * 0.10 * edge * sky)[..., None] * np.array([0.6, 0.85, 1.0])


def _tiles(place: np.ndarray, normal: np.ndarray, size: float) -> np.ndarray:
    """Thin brighter lines each `size` metres, on whatever axes lie in the plane."""
    share = np.abs((place / size) % 1.0 - 0.5)
    line = ((share > 0.485) & (np.abs(normal) < 0.5)).any(axis=1)
    return 1.0 + 0.55 * line


def _mottle(place: np.ndarray, radius: float) -> np.ndarray:
    """Stains that move with the stone."""
    x, y, z = (place / radius * 3.1).T
    return (
        0.85
        + 0.18 * np.sin(2.3 * x + np.sin(3.7 * y)) * np.cos(2.9 * z + np.sin(4.1 * x))
        + 0.08 * np.sin(9 * y + 5 * z)
    )
