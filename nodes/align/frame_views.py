"""What the cameras saw of the frames of all takes, a few frames at a time."""

from __future__ import annotations

import threading

import cv2
import numpy as np

from reperform.nodes.kernels.mesh_geometry import vertex_normals
from reperform.nodes.kernels.registration import Tracker
from reperform.nodes.kernels.texture_tracks import Camera, Seen, Sights, see, track_surface
from reperform.nodes.product import Dataset
from reperform.nodes.products.cameras import Cameras
from reperform.nodes.products.footage import Footage

# Frames whose grey pictures are kept: a parent and its children come soon after each other, on every branch.
_KEPT = 8
# Pyramid levels of the first look, and of those that start from a coarse fit.
_FIRST, _LATER = 3, 1
# Every other vertex is tracked: neighbours share most of their window.
_EVERY = 2


class FrameViews:
    """Grey pictures and cameras of frames (take, instant), and trackers between two of them."""

    def __init__(self, footage: Dataset[Footage], cameras: Dataset[Cameras]) -> None:
        self._footage, self._cameras = footage, cameras
        self._pictures: dict[tuple[str, int], list[np.ndarray]] = {}
        self._lock = threading.Lock()

    def tracker(
        self,
        frames: tuple[tuple[str, int], tuple[str, int]],
        pose: np.ndarray,
        faces: np.ndarray,
        trip: float,
    ) -> Tracker | None:
        """Tracks from a frame where the mesh is known (V, 3) to another; None where the rigs differ in size.

        Raises ValueError where a take has no footage or no cameras, or they are not as many.
        """
        rigs = self._rig(frames[0][0]), self._rig(frames[1][0])
        if len(rigs[0]) != len(rigs[1]):
            return None
        pictures = self._grey(*frames[0]), self._grey(*frames[1])
        before = _seen(pose, faces, rigs[0], pictures[0])

        def look(expected: np.ndarray, number: int) -> Sights:
            after = _seen(expected, faces, rigs[1], pictures[1])
            levels = _FIRST if number == 0 else _LATER
            return track_surface(pictures, rigs, (before, after), levels, trip)

        return look

    def _rig(self, take: str) -> list[Camera]:
        for what, there in (("footage", self._footage), ("cameras", self._cameras)):
            if take not in there:
                raise ValueError(f"register: take {take} has no {what}: give all takes {what}, or none")
        rig = self._cameras[take]
        fields = [np.asarray(field) for field in (rig.matrix, rig.rotation, rig.translation, rig.distortion)]
        count = self._footage[take].images.shape[1]
        if len(fields[0]) != count:
            raise ValueError(
                f"register: take {take} has footage of {count} cameras but a rig of {len(fields[0])}: "
                "wire the cameras that filmed it"
            )
        return [(m, r, t, d) for m, r, t, d in zip(*fields, strict=True)]

    def _grey(self, take: str, instant: int) -> list[np.ndarray]:
        key = (take, instant)
        pictures = self._pictures.get(key)
        if pictures is None:
            images = self._footage[take].images
            pictures = [
                cv2.cvtColor(np.asarray(images[instant, c]), cv2.COLOR_RGB2GRAY)
                for c in range(images.shape[1])
            ]
            with self._lock:
                self._pictures[key] = pictures
                while len(self._pictures) > _KEPT:
                    del self._pictures[next(iter(self._pictures))]
        return pictures


def _seen(
    vertices: np.ndarray, faces: np.ndarray, rig: list[Camera], pictures: list[np.ndarray]
) -> list[Seen]:
    normals = vertex_normals(vertices, faces)
    skipped = np.arange(len(vertices)) % _EVERY != 0
    views = [
        see(vertices, normals, faces, camera, *picture.shape)
        for camera, picture in zip(rig, pictures, strict=True)
    ]
    return [view._replace(facing=np.where(skipped, 0.0, view.facing)) for view in views]
