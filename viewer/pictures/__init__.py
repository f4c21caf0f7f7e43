"""Pictures of products, drawn without a display."""

from reperform.viewer.pictures.canvas import png
from reperform.viewer.pictures.look import Look, View
from reperform.viewer.pictures.matrix import matrices_picture
from reperform.viewer.pictures.picture import overview, picture

__all__ = ["Look", "View", "matrices_picture", "overview", "picture", "png"]
