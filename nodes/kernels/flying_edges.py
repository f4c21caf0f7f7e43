"""Isosurfaces of fields on a regular grid."""

from __future__ import annotations

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D


def isosurface(field: np.ndarray, level: float) -> tuple[np.ndarray, np.ndarray]:
    """The closed surface field = level: vertices (V, 3) float64 in voxels, faces (F, 3) int32.

    field (x, y, z) is linear between samples and below `level` outside the grid; faces are counter-clockwise seen
    from where the field is smaller. Samples closer to `level` than 1e-4 are moved off it, so that no face
    degenerates.

    Source: Lorensen and Cline 1987, SIGGRAPH; Schroeder, Maynard and Geveci 2015, LDAV (flying edges).
    """
    padded = np.pad(field.astype(np.float32) - np.float32(level), 1, constant_values=-level)
    near = np.abs(padded) < 1e-4
    padded[near] = np.where(padded[near] < 0, np.float32(-1e-4), np.float32(1e-4))
    image = vtkImageData()
    # VTK runs through x first, the array through z: to VTK the field is mirrored, x and z changed over.
    image.SetDimensions(*padded.shape[::-1])
    image.GetPointData().SetScalars(numpy_to_vtk(padded.ravel()))
    contour = vtkFlyingEdges3D()
    contour.SetInputData(image)
    contour.SetValue(0, 0.0)
    contour.ComputeNormalsOff()
    contour.ComputeScalarsOff()
    contour.Update()
    mesh = contour.GetOutput()
    if mesh.GetNumberOfPoints() == 0:
        return np.zeros((0, 3)), np.zeros((0, 3), np.int32)
    points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(np.float64)[:, ::-1] - 1.0
    faces = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)[:, ::-1].astype(np.int32)
    return np.ascontiguousarray(points), np.ascontiguousarray(faces)
