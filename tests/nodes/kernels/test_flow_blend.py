import cv2
import numpy as np
import pytest

from reperform.nodes.kernels.flow_blend import flow_blend

HEIGHT, WIDTH = 120, 150


def pattern(shift: float) -> np.ndarray:
    """A smooth random picture, moved by `shift` px to the right (and a third of it down)."""
    noise = np.random.default_rng(3).uniform(0, 255, (HEIGHT, WIDTH, 3)).astype(np.float32)
    base = cv2.GaussianBlur(noise, (0, 0), 3)
    base = (base - base.mean()) * 8 + 128
    move = np.array([[1, 0, shift], [0, 1, shift / 3]], np.float32)
    return cv2.warpAffine(base, move, (WIDTH, HEIGHT), flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REFLECT)


@pytest.fixture
def inside() -> np.ndarray:
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    return ((x - 78) / 55) ** 2 + ((y - 57) / 45) ** 2 < 1


@pytest.mark.parametrize("method", ["dis", "farneback"])
@pytest.mark.parametrize("weight", [0.25, 0.5, 0.8])
def test_between_two_places_the_pattern_is_between(inside, method, weight):
    first, second, truth = pattern(0), pattern(5), pattern(5 * (1 - weight))
    core = cv2.erode(inside.astype(np.uint8), np.ones((13, 13))) > 0
    error = {
        way: np.abs(flow_blend(first, second, weight, inside, method=way) - truth)[core].mean()
        for way in (method, "none")
    }
    assert error[method] < 0.4 * error["none"]
    assert error[method] < 4


def test_end_points_are_exact(inside):
    first, second = pattern(0), pattern(5)
    np.testing.assert_array_equal(flow_blend(first, second, 1.0, inside), first)
    np.testing.assert_array_equal(flow_blend(first, second, 0.0, inside), second)


def test_it_makes_no_difference_which_is_first(inside):
    first, second = pattern(0), pattern(5)
    one, two = flow_blend(first, second, 0.3, inside), flow_blend(second, first, 0.7, inside)
    assert np.abs(one - two)[inside].max() < 0.01


def test_what_only_one_knows_comes_from_that_one(inside):
    first, second = np.full((HEIGHT, WIDTH, 3), 200, np.float32), np.full((HEIGHT, WIDTH, 3), 100, np.float32)
    confidence = np.ones((2, HEIGHT, WIDTH), np.float32)
    confidence[1, :, :70] = 0
    blended = flow_blend(first, second, 0.5, inside, confidence)
    assert np.abs(blended[50, 40] - 200).max() < 0.5
    assert np.abs(blended[50, 110] - 150).max() < 0.5


def test_unrelated_pictures_fall_back_to_a_cross_fade(inside):
    random = np.random.default_rng(0)
    first, second = (random.uniform(0, 255, (HEIGHT, WIDTH, 3)).astype(np.float32) for _ in range(2))
    blended = flow_blend(first, second, 0.5, inside)
    assert np.median(np.abs(blended - (first + second) / 2)[inside]) < 12
