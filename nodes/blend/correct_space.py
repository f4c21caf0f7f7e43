"""Corrections for a parametric space, so that it is blended as well in real time as non-linearly off line."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from reperform.nodes.blend.cell_fields import packed_cells
from reperform.nodes.declaration import Param, node
from reperform.nodes.kernels.hybrid_build import Codes, build_hybrid, nonlinear_blends
from reperform.nodes.products.parametric import ParametricSpace
from reperform.nodes.products.space_corrections import SpaceCorrections


@node(over="dataset", memory=2.0)
def correct_space(
    space: ParametricSpace,
    *,
    epsilon: Annotated[float, Param("m", 0.0, 1.0, "error that needs no correction")] = 0.005,
    levels: Annotated[
        int,
        Param("1", 0, 6, "how often weights are halved everywhere; 0: where and until the error is small"),
    ] = 1,
    deepest: Annotated[int, Param("1", 1, 6, "how often weights are halved at most")] = 3,
    codes: Annotated[
        Codes,
        Param(about="what corrections are rounded to; auto: int8 where that errs by epsilon / 10 at most"),
    ] = "auto",
) -> SpaceCorrections:
    """What has to be added to the linear blend, cell by cell of the space, to come near to the non-linear one.

        x(w) = sum_i w_i x_i + sum_k h_k(w) d_k

    as in blend.hybrid, over the weights of the corners of a cell, since no more are ever blended: nine takes under two
    parameters need corrections of triangles, not of a simplex of nine. With `levels` given, two cells halve their
    common side alike, and differ there by twice epsilon at most. The takes themselves stay exact.

    Source: Casas, Tejera, Guillemaut and Hilton 2013, IEEE TVCG (001 eq 3 and section 3.1.2; 004 eqs 3.6-3.8).
    Departure: corrections per cell of neighbouring takes, hierarchical, in codes.
    """
    vertices, faces = np.asarray(space.vertices), np.asarray(space.faces)
    built = []
    for corners in np.asarray(space.cells):
        inputs = np.ascontiguousarray(vertices[corners], np.float32)
        # one rest for all cells, or blends on a common side would depend on the cell
        exact = nonlinear_blends(inputs, faces, vertices[0, 0])
        built.append(build_hybrid(inputs, exact, epsilon, levels, deepest, codes))
    return packed_cells(space, built, epsilon)
