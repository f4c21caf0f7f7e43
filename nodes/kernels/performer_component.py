"""Which of the regions of a matte is the performer."""

from __future__ import annotations

import cv2
import numpy as np

# A region that the picture's edge cuts weighs this much: rigs and floor edges hang on the edge, performers do not.
_EDGE_WEIGHT = 0.1


def performer_component(mask: np.ndarray, gap: int, smallest: int) -> np.ndarray:
    """The region of a mask (y, x) bool that is the performer; all False where there is none.

    Pieces closer than `gap` px count as one region. Regions are weighed by area, those on the top, left or right
    edge of the picture by a tenth of it (the bottom edge may cut a performer's legs); none under `smallest` px
    counts. Ties go to the region that comes first from the top.
    """
    whole = mask.astype(np.uint8)
    joined = whole
    if gap > 0:
        joined = cv2.dilate(whole, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (gap | 1, gap | 1)))
    count, labels = cv2.connectedComponents(joined, connectivity=8, ltype=cv2.CV_32S)
    areas = np.bincount(labels[mask], minlength=count).astype(np.float64)
    areas[0] = 0
    areas[areas < smallest] = 0
    cut = np.unique(
        np.concatenate([labels[0][mask[0]], labels[:, 0][mask[:, 0]], labels[:, -1][mask[:, -1]]])
    )
    areas[cut] *= _EDGE_WEIGHT
    best = int(areas.argmax())
    return mask & (labels == best) if areas[best] > 0 else np.zeros_like(mask)


def fill_small_holes(mask: np.ndarray, largest: int) -> np.ndarray:
    """The mask with holes of at most `largest` px filled."""
    holes = (~mask).astype(np.uint8)
    count, labels = cv2.connectedComponents(holes, connectivity=4, ltype=cv2.CV_32S)
    areas = np.bincount(labels.ravel(), minlength=count)
    small = areas <= largest
    small[0] = False
    for edge in (labels[0], labels[-1], labels[:, 0], labels[:, -1]):
        small[edge] = False
    return mask | small[labels]
