import numpy as np
import pytest

from reperform.nodes.kernels.obstacle_path import Obstacles, clearance
from reperform.nodes.synthesis.play_path import play_path

PATH = {"points": ("0 0", "1.2 3", "-1 6", "0.5 9"), "space": "walk"}


def test_it_stays_on_the_path_round_obstacles_to_the_end(playable):
    played = play_path(
        *playable, **PATH, circles=("0.2 4.6 0.3",), boxes=("-0.4 7.2 0.2 0.2 0.5",), margin=0.3
    )
    near = np.linalg.norm(played.root[:, None, :2] - played.way[None], axis=-1)
    assert near.min(axis=1).max() < 0.15
    assert np.linalg.norm(played.root[-1, :2] - (0.5, 9)) < 0.2
    obstacles = Obstacles(np.array([[0.2, 4.6, 0.3]]), np.array([[-0.4, 7.2, 0.2, 0.2, 0.5]]))
    assert clearance(obstacles, played.root[:, :2])[0].min() > 0.15


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"points": ("0 0",)}, "two points X Z or more, got 1"),
        ({"points": ("0 0", "1 z")}, "points must be numbers"),
        ({"circles": ("1 2",)}, "each of circles is 3 numbers"),
        ({"space": "jump"}, "'jump' has height"),
        ({"circles": ("0 0 0.5",)}, "ends must be"),
    ],
)
def test_what_cannot_be_followed_is_told(playable, change, says):
    with pytest.raises(ValueError, match=says):
        play_path(*playable, **{**PATH, **change})
