"""A painted picture in other colours."""

from __future__ import annotations

from typing import Annotated

import cv2
import numpy as np

from reperform.nodes.declaration import Param, node
from reperform.nodes.products.mesh import TextureAtlas


@node(over="take", memory=0.5)
def dye(
    texture: TextureAtlas,
    *,
    hue: Annotated[float, Param("deg", -360.0, 360.0, "by which every hue turns; 120: red to green")] = 0.0,
    value: Annotated[float, Param("1", 0.0, 4.0, "factor of brightness")] = 1.0,
) -> TextureAtlas:
    """The picture with its hues turned, for the same cloth in another colour; saturation stays.

    Source: Smith 1978, SIGGRAPH (hue, saturation, value).
    """
    if hue % 360 == 0 and value == 1:
        return texture
    hsv = cv2.cvtColor(np.asarray(texture.image, np.float32) / 255, cv2.COLOR_RGB2HSV)
    hsv[..., 0] = (hsv[..., 0] + hue) % 360
    hsv[..., 2] = np.minimum(hsv[..., 2] * value, 1)
    turned = np.rint(255 * cv2.cvtColor(hsv, cv2.COLOR_HSV2RGB))
    return texture._replace(image=np.clip(turned, 0, 255).astype(np.uint8))
