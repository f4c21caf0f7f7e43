import numpy as np
import pytest
import trimesh

from reperform.nodes.blend.hybrid import hybrid
from reperform.nodes.evaluate.blend_errors import METHODS, blend_errors
from reperform.nodes.evaluate.blend_table import blend_table
from reperform.nodes.evaluate.threshold_curves import threshold_curves
from reperform.nodes.kernels.rotation import exp
from reperform.nodes.products.blend_measures import PosePairs
from reperform.nodes.products.measures import Measures
from reperform.nodes.products.mesh import MeshSequence
from reperform.viewer.pictures.look import Look
from reperform.viewer.pictures.picture import picture

SIZE = (420, 320)


@pytest.fixture(scope="module")
def products():
    box = trimesh.creation.box(extents=[0.3, 1.0, 0.2]).subdivide().subdivide()
    vertices, faces = np.asarray(box.vertices) + [0, 0.5, 0], np.asarray(box.faces, np.int32)
    poses = np.array([vertices @ exp(np.array([0.1, 0.2, a])).T for a in (0.0, 1.5)], np.float32)
    takes = {
        name: MeshSequence(poses[k : k + 1], faces, np.asarray(25.0, np.float32))
        for k, name in enumerate("ab")
    }
    pairs = PosePairs(np.array(["p"]), poses[:1], poses[1:], np.full_like(poses[:1], np.nan), faces)
    errors = blend_errors(pairs, steps=4)
    times = Measures(np.ones((1, 4)), np.array(METHODS), np.array(["s"] * 4))
    return {
        "space": hybrid(takes, place=False, levels=1),
        "errors": errors,
        "table": blend_table({"x": errors}, {"t": times}),
        "curves": threshold_curves(takes, epsilons=(0.0, 0.01, 0.1), levels=2),
    }


@pytest.mark.parametrize("name", ["space", "errors", "table", "curves"])
def test_it_is_drawn_in_the_size_asked_for(products, name):
    image = picture(products[name], 0, Look(size=SIZE))
    assert image.shape == (SIZE[1], SIZE[0], 3) and image.dtype == np.uint8
    assert image.std() > 5


def test_what_is_corrected_is_red_in_the_linear_row(products):
    image = picture(products["space"], 0, Look(size=(600, 400))).astype(int)
    red = (image[..., 0] > 1.6 * image[..., 2]) & (image[..., 0] > 1.6 * image[..., 1])
    assert red[:200].sum() > 20 and red[200:].sum() == 0
