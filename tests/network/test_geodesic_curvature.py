"""kg of sampled curves from the turning of their tangents: of second order, at their ends as inside.

The closed forms answer kg exactly (DESIGN section 9: catenoid kg = sinh u / (sqrt2 c cosh^2 u) on its lamellas, the
helicoid's helices sinh u / (c cosh^2 u), its rulings 0).
"""

from __future__ import annotations

import numpy as np
import pytest

import lamella
from lamella import Catenoid, Enneper, Helicoid, Unduloid
from lamella.network.elements.element_network import element_network
from lamella.network.network import Network
from lamella.network.turning import turning
from lamella.surface.closed_forms.closed_form import ClosedForm
from network.elements.test_element_network import catenoid

FORMS = {
    "catenoid": Catenoid(1.0, (-0.8, 1.1)),
    "unduloid": Unduloid(0.6, 1.2, (-0.9, 1.3)),
    "helicoid": Helicoid(5.0, 0.3, 2.0, 0.8),
    "Enneper": Enneper(2, 0.9, 2.0),
}


def from_ends(network: Network) -> np.ndarray:
    """Samples between each sample and the nearer end of its lamella."""
    offsets, index = network.sample_offsets, np.arange(len(network.sample_points))
    first, last = (np.repeat(at, np.diff(offsets)) for at in (offsets[:-1], offsets[1:] - 1))
    return np.minimum(index - first, last - index)


def turned(network: Network) -> np.ndarray:
    return turning(
        network.sample_tangents,
        np.cross(network.sample_normals, network.sample_tangents),
        network.sample_arclengths,
        network.sample_offsets,
        network.closed,
    )


@pytest.mark.parametrize("name", FORMS)
def test_exact_tangents(name: str) -> None:
    """From the closed forms' own tangents: whatever the rim cuts off, stubs of a thousandth of a cell too."""
    form: ClosedForm = FORMS[name]
    cells = np.array([16, 32, 64])
    errors = np.empty((2, len(cells)))
    for k, count in enumerate(cells.tolist()):
        network = lamella.net(form, cells=count)
        error = np.abs(turned(network) - network.sample_darboux.kg)
        far = from_ends(network)
        errors[:, k] = error[far == 0].max(), error[far > 8].max()
    orders = np.log(errors[:, 0] / errors[:, -1]) / np.log(cells[-1] / cells[0])
    print(name, *(" ".join(f"{e:.1e}" for e in row) for row in errors), orders)
    assert (orders > 1.8).all()
    # t''' (c - a)^2 / 12 at a parabola's ends, half of it in its middle
    assert errors[0, -1] < 2 * errors[1, -1]


def test_lamellas_of_elements() -> None:
    """The catenoid's, on elements: at the ends the error falls as inside, and is of the same size."""
    _, surface = catenoid(72, 39)
    errors = []
    for cells in (10, 20):
        network = element_network(surface, cells=cells).network
        x, y, _ = network.sample_points.T
        sinh = np.sqrt(np.maximum(x**2 + y**2 - 1, 0))
        exact = sinh / (np.sqrt(2) * (1 + sinh**2))
        error = np.abs(np.abs(network.sample_darboux.kg) - exact)
        far = from_ends(network)
        errors.append([error[far == 0].max(), error[far > 8].max()])
    (end, inside), (end_half, inside_half) = errors
    assert np.log2(end / end_half) > 1.7
    assert np.log2(inside / inside_half) > 1.7
    assert end_half < 2 * inside_half


def test_a_stub_at_the_end() -> None:
    """A circle of latitude on a sphere, kg = cot(polar angle): three samples in a stub whose tangents are rounded."""
    polar, radius = 0.7, 2.0
    arc = np.r_[np.linspace(0, 1.5, 33), 1.5 + 1e-10 * np.arange(1, 4)]
    angle = arc / (radius * np.sin(polar))
    normals = np.stack([np.sin(polar) * np.cos(angle), np.sin(polar) * np.sin(angle), 0 * angle + np.cos(polar)], 1)
    tangents = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], 1)
    tangents += 1e-9 * np.random.default_rng(1).normal(size=tangents.shape)
    kg = turning(tangents, np.cross(normals, tangents), arc, np.array([0, len(arc)]), np.array([False]))
    exact = 1 / (np.tan(polar) * radius)
    # (3 h)^2 / 6 of the third derivative inside, (3 h) (6 h) / 6 at the ends
    bound = (1.5 / 32) ** 2 * 3 / (radius * np.sin(polar)) ** 2
    assert np.abs(kg / exact - 1).max() < 1.1 * bound


def test_a_closed_curve_has_no_end() -> None:
    """An ellipse with half axes 3 and 2: kg = 6 / (9 sin^2 + 4 cos^2)^(3/2) in the plane, its ends at any place."""
    orders = []
    for begin in (0.0, 0.9):
        errors = []
        for count in (100, 200):
            angle = begin + np.linspace(0, 2 * np.pi, count + 1)
            velocity = np.stack([-3 * np.sin(angle), 2 * np.cos(angle), 0 * angle], 1)
            speed = np.linalg.norm(velocity, axis=1)
            fine = begin + np.linspace(0, 2 * np.pi, 100 * count + 1)
            steps = np.hypot(3 * np.sin(fine), 2 * np.cos(fine))
            run = np.r_[0, np.cumsum((steps[1:] + steps[:-1]) / 2 * np.diff(fine))][::100]
            tangents = velocity / speed[:, None]
            normals = np.tile([0.0, 0.0, 1.0], (len(angle), 1))
            kg = turning(tangents, np.cross(normals, tangents), run, np.array([0, len(run)]), np.array([True]))
            assert kg[0] == pytest.approx(kg[-1], rel=1e-9)
            error = np.abs(kg - 6 / speed**3)
            errors.append(error.max())
            if begin:
                # nothing happens at the seam
                assert error[[0, 1, 2, -2, -1]].max() < 0.5 * error.max()
        orders.append(np.log2(errors[0] / errors[1]))
    assert min(orders) > 1.8
