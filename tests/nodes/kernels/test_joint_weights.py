import numpy as np
import pytest

from reperform.nodes.kernels.joint_weights import joint_weights


def test_by_name_and_one_elsewhere():
    np.testing.assert_allclose(joint_weights("x", ["a", "b"], {"b": 3}), [1, 3])


def test_refuses_what_cannot_be_weighted():
    with pytest.raises(ValueError, match="x: no joint c"):
        joint_weights("x", ["a", "b"], {"c": 1})
    with pytest.raises(ValueError, match="one positive"):
        joint_weights("x", ["a"], {"a": 0})
