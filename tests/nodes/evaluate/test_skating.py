import numpy as np
import pytest

from reperform.nodes.evaluate.skating import skating
from reperform.nodes.synthesis.play_script import play_script


@pytest.fixture(scope="module")
def played(playable):
    return play_script(*playable, script=("0 walk speed=1.2", "2 jump", "4 walk"), seconds=5.0)


def test_feet_that_are_held_do_not_skate(played):
    got = skating(played)
    assert list(got.name) == ["foot 0", "foot 1"]
    assert np.isfinite(got.value).mean() > 0.3
    assert np.nanmean(got.value) < 0.02


def test_a_mesh_that_slides_is_found_out(played):
    """Drawn along at 0.1 m/s, no faster than a foot may rest, the soles skate by so much."""
    slid = played.mesh.vertices.copy()
    slid[..., 0] += 0.1 * np.arange(len(slid))[:, None] / float(played.mesh.fps)
    got = skating(played._replace(mesh=played.mesh._replace(vertices=slid)))
    assert np.nanmedian(got.value) == pytest.approx(0.1, abs=0.01)
    planted = played.planted[1:] & played.planted[:-1]
    np.testing.assert_array_equal(np.isfinite(got.value[1:]), planted)
