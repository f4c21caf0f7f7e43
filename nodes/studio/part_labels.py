"""The body parts of the virtual actor."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.products.part_labels import PartLabels
from reperform.nodes.studio.actor import build_actor
from reperform.nodes.studio.actor_parts import Costume
from reperform.nodes.studio.actor_skeleton import NAMES


@node(over="dataset")
def part_labels(
    *, costume: Annotated[Costume, Param("", about="what the actor wears")] = "skirt"
) -> PartLabels:
    """Parts named after the bones that carry them most; a loose garment is shared by hips and thighs.

    Source: 000 section 3 (marked by hand there); here by the skinning weights.
    """
    actor = build_actor(costume)
    label = np.argmax(actor.weights, axis=1).astype(np.int32)
    return PartLabels(label, np.array(NAMES))
