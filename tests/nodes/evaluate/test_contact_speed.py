import numpy as np
import pytest

from reperform.nodes.evaluate.contact_speed import contact_speed
from reperform.nodes.kernels.rotation import exp
from reperform.nodes.products.mesh import MeshSequence
from reperform.nodes.products.motion import Animation
from reperform.nodes.products.performance import Contacts


def test_what_is_carried_along_slides_as_fast_as_it_is_carried(
    carried: Animation, standing: dict[str, MeshSequence]
) -> None:
    measured = contact_speed(carried, standing)
    assert measured.name.tolist() == ["slide", "sole"]
    assert np.isnan(measured.value[0]).all()
    np.testing.assert_allclose(measured.value[1:-1], 0.5, atol=1e-4)


def test_turning_on_the_spot_is_no_slide(carried: Animation, standing: dict[str, MeshSequence]) -> None:
    still = standing["stand"].vertices
    leg = still[0, :, 0] > 0.12
    pivot = still[0, leg & (still[0, :, 1] < 0.01)].mean(axis=0) * [1, 0, 1]
    turns = exp(np.arange(len(still))[:, None] * np.array([0, 0.02, 0]))
    turned = np.einsum("tij,tvj->tvi", turns, still - pivot) + pivot
    spinning = carried._replace(mesh=carried.mesh._replace(vertices=turned.astype(np.float32)))
    measured = [
        contact_speed(spinning, standing, {"stand": Contacts(np.tile(rests, (30, 1)))}).value[1:]
        for rests in ([True, False], [False, True])
    ]
    pivoting, other = sorted(measured, key=lambda value: float(value[:, 0].max()))
    assert pivoting[:, 0].max() < 1e-4 < 0.01 < pivoting[:, 1].min()
    assert other[:, 0].min() > 0.1


def test_only_contacts_count(carried: Animation, standing: dict[str, MeshSequence]) -> None:
    planted = np.zeros((30, 2), bool)
    planted[10:14, 1] = True
    measured = contact_speed(carried, standing, {"stand": Contacts(planted)})
    assert np.flatnonzero(np.isfinite(measured.value[:, 0])).tolist() == [11, 12, 13]
    with pytest.raises(ValueError, match="contacts are of 3 feet"):
        contact_speed(carried, standing, {"stand": Contacts(np.zeros((30, 3), bool))})
