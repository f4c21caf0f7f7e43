"""The picture of a played motion shows where it went and what plays."""

import numpy as np
import pytest

from reperform.nodes.products.played import Played
from reperform.nodes.synthesis.play_script import play_script
from reperform.viewer.palette import rgb
from reperform.viewer.pictures import Look, picture
from reperform.viewer.pictures.played import _colour

SIZE = (900, 520)


@pytest.fixture(scope="module")
def played(playable) -> Played:
    script = ("0 walk speed=1.2", "1.5 jump height=0.3", "4 walk speed=1.4 turning=0.5")
    return play_script(*playable, script=script, seconds=6.0, fps=25.0)


def _inked(image: np.ndarray, space: int) -> int:
    return int((np.abs(image.astype(int) - rgb(_colour(space))).sum(axis=2) < 20).sum())


def test_what_plays_is_drawn_in_its_colour(played):
    image = picture(played, 80, Look(size=SIZE))
    assert image.shape == (520, 900, 3)
    assert min(_inked(image, 0), _inked(image, 1)) > 40
    only = played._replace(space=np.zeros_like(played.space))
    assert _inked(picture(only, 80, Look(size=SIZE)), 1) == 0


def test_what_is_done_is_what_was_asked_once_it_plays(played):
    names = played.parameters.tolist()
    speed, height = names.index("speed"), names.index("height")
    assert played.asked[0, speed] == pytest.approx(1.2)
    assert played.done[30, speed] == pytest.approx(1.2, abs=0.02)
    in_jump = played.spaces[played.space] == "jump"
    assert np.isnan(played.done[~in_jump, height]).all()
    assert played.done[np.flatnonzero(in_jump)[-1], height] == pytest.approx(0.3, abs=0.01)
