"""One cycle of a motion that repeats itself."""

from __future__ import annotations

import numpy as np

# shortest cycle looked for, s
_SHORTEST = 0.3


def find_cycle(distance: np.ndarray, fps: float, starts: np.ndarray) -> tuple[float, float] | None:
    """Start and length (frames, not whole) of one cycle; None where the take does not repeat itself.

    distance: (T, T) root mean square distance of poses apart from where they stand, m. starts: frames at which a
    cycle may begin (contacts), may be empty: then it begins where it closes best.

        length = the lag with the least mean_i d(i, i + lag)^2 among local minima, refined by a parabola;
        of lags within a tenth of the spread of the least, the shortest
    """
    square = np.asarray(distance, np.float64) ** 2
    frames = len(square)
    least = max(3, round(_SHORTEST * fps))
    lags = np.arange(least - 1, frames - 1)
    if len(lags) < 3:
        return None
    cost = np.array([np.diagonal(square, lag).mean() for lag in lags])
    inner = cost[1:-1]
    dips = np.flatnonzero((inner <= cost[:-2]) & (inner < cost[2:])) + 1
    if not len(dips):
        return None
    close = dips[cost[dips] <= cost[dips].min() + 0.1 * (square.mean() - cost[dips].min())]
    k = int(close[0])
    below, here, above = cost[k - 1 : k + 2]
    length = float(lags[k] + 0.5 * (below - above) / max(below - 2 * here + above, 1e-30))
    last = frames - 1 - length
    fitting = starts[(starts >= 0) & (starts <= last)]
    if len(fitting):
        return float(fitting[0]), length
    ends = np.arange(0, int(last) + 1)
    return float(ends[int(np.argmin(square[ends, np.minimum(ends + round(length), frames - 1)]))]), length


def close_loop(values: np.ndarray) -> np.ndarray:
    """Values (K + 1, ...) of one cycle and its first pose again, made periodic: (K, ...).

    The gap between both ends is spread over the cycle, half of it to either side of the join.
    """
    count = len(values) - 1
    share = (0.5 - np.arange(count) / count).reshape(-1, *[1] * (values.ndim - 1))
    return np.asarray(values[:-1] + share * (values[-1] - values[0]))
