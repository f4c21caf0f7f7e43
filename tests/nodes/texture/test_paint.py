import numpy as np
import pytest

from reperform.nodes.texture.paint import paint


def test_colours_follow_the_vertices_not_the_pose(scene):
    takes = {"a": scene.mesh, "b": scene.mesh._replace(vertices=scene.mesh.vertices[::-1])}
    painted = paint(takes)
    assert painted.colour.shape == scene.rest.shape
    np.testing.assert_array_equal(painted.colour, paint({"a": scene.mesh}).colour)
    assert len(np.unique(paint(takes, pattern="rainbow").colour, axis=0)) > 500


def test_checker_changes_over_a_cell(scene):
    plain, checked = (paint({"a": scene.mesh}, pattern=p).colour.astype(int) for p in ("rainbow", "checker"))
    low = scene.mesh.vertices[0].min(axis=0)
    odd = np.floor((scene.mesh.vertices[0].astype(float) - low) / 0.06).sum(axis=1).astype(int) % 2 == 1
    np.testing.assert_array_equal(plain[~odd], checked[~odd])
    assert (checked[odd].sum(axis=1) < 0.5 * plain[odd].sum(axis=1)).all()


def test_refusals(scene):
    with pytest.raises(ValueError, match=r"take must be one of \['a'\]"):
        paint({"a": scene.mesh}, take="b")
    with pytest.raises(ValueError, match="frame must be under 2"):
        paint({"a": scene.mesh}, frame=2)
    with pytest.raises(ValueError, match="share one topology"):
        paint({"a": scene.mesh, "b": scene.mesh._replace(faces=scene.mesh.faces[1:])})
