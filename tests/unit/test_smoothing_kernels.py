"""The smoothing kernels of eqs. 2.14 to 2.16, as the device functions compute them."""

import numpy as np
import pytest
from fontana._core import smoothing_kernel

SUPPORT = 0.04
KERNELS = ("poly6", "spiky", "viscosity")


def sample(kernel, quantity, radii):
    return np.array([smoothing_kernel(kernel, quantity, r, SUPPORT) for r in radii])


@pytest.mark.parametrize("kernel", KERNELS)
def test_integrates_to_one(kernel):
    """The integral over the support, in spherical shells; exact to float's rounding."""
    edges = np.linspace(0.0, SUPPORT, 20001)
    middle = 0.5 * (edges[1:] + edges[:-1])
    integral = np.sum(sample(kernel, "value", middle) * 4.0 * np.pi * middle**2) * (edges[1] - edges[0])
    assert integral == pytest.approx(1.0, abs=1e-4)


@pytest.mark.parametrize("kernel", KERNELS)
def test_support_ends_at_the_support_radius(kernel):
    assert sample(kernel, "value", [SUPPORT, 1.0001 * SUPPORT, 3.0 * SUPPORT]).tolist() == [0.0, 0.0, 0.0]
    assert sample(kernel, "value", np.linspace(0.05, 0.95, 10) * SUPPORT).min() > 0.0


@pytest.mark.parametrize("kernel", ("poly6", "spiky"))
def test_gradient_matches_finite_difference(kernel):
    radii = np.linspace(0.1, 0.9, 9) * SUPPORT
    step = 1e-2 * SUPPORT
    difference = (sample(kernel, "value", radii + step) - sample(kernel, "value", radii - step)) / (2.0 * step)
    gradient = sample(kernel, "gradient", radii)
    assert np.abs(gradient - difference).max() < 2e-3 * np.abs(gradient).max()


@pytest.mark.parametrize("kernel", ("poly6", "viscosity"))
def test_laplacian_matches_finite_difference(kernel):
    """In spherical coordinates: (r W)'' / r."""
    radii = np.linspace(0.3, 0.9, 7) * SUPPORT
    step = 3e-2 * SUPPORT

    def weighted(r):
        return r * sample(kernel, "value", r)

    difference = (weighted(radii + step) - 2.0 * weighted(radii) + weighted(radii - step)) / (step**2 * radii)
    laplacian = sample(kernel, "laplacian", radii)
    assert np.abs(laplacian - difference).max() < 1e-2 * np.abs(laplacian).max()


def test_unknown_names_are_refused_with_the_choices():
    with pytest.raises(Exception, match="expected poly6"):
        smoothing_kernel("gauss", "value", 0.01, SUPPORT)
    with pytest.raises(Exception, match="above 0"):
        smoothing_kernel("poly6", "value", 0.01, 0.0)
