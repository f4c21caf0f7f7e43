import numpy as np

from reperform.nodes.kernels.contact_keys import common_keys, contact_events


def feet(*spans: tuple[tuple[int, int], ...]) -> np.ndarray:
    """(30, 2) bool, planted within each foot's spans."""
    out = np.zeros((30, 2), bool)
    for foot, down in enumerate(spans):
        for first, last in down:
            out[first:last, foot] = True
    return out


WALK = feet(((0, 13), (20, 30)), ((8, 24),))
QUICK = feet(((0, 10), (17, 30)), ((6, 20),))
JOG = feet(((0, 8), (20, 30)), ((10, 18),))


def test_events_lie_between_frames():
    assert contact_events(WALK) == [
        (7.5, "right down"),
        (12.5, "left up"),
        (19.5, "left down"),
        (23.5, "right up"),
    ]


def test_a_blink_of_one_frame_is_no_event():
    blinking = WALK.copy()
    blinking[4, 0] = False
    assert contact_events(blinking) == contact_events(WALK)


def test_all_events_where_orders_agree_else_feet_coming_down():
    assert common_keys([contact_events(take) for take in (WALK, QUICK)]).tolist() == [
        [7.5, 12.5, 19.5, 23.5],
        [5.5, 9.5, 16.5, 19.5],
    ]
    # a jog lifts the left foot before the right one comes down
    assert common_keys([contact_events(take) for take in (WALK, JOG)]).tolist() == [[7.5, 19.5], [9.5, 19.5]]
    assert common_keys([contact_events(WALK), contact_events(feet((), ()))]).shape == (2, 0)
