"""Arrays whose length differs from frame to frame."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np


class Ragged:
    """A list of arrays of one dtype, one per frame, that may differ in shape.

    `ragged[k]` is frame k; iteration and `len` follow the frames; `ragged[a:b]` is a shorter `Ragged`.
    """

    __slots__ = ("arrays",)

    def __init__(self, arrays: Sequence[np.ndarray]) -> None:
        self.arrays = tuple(np.asarray(array) for array in arrays)
        kinds = {(array.dtype, array.ndim) for array in self.arrays}
        if len(kinds) > 1:
            raise ValueError(
                f"a ragged field needs one dtype and rank in all frames, got {sorted(map(str, kinds))}"
            )

    def __len__(self) -> int:
        return len(self.arrays)

    def __iter__(self) -> Iterator[np.ndarray]:
        return iter(self.arrays)

    def __getitem__(self, index: int | slice) -> np.ndarray | Ragged:
        return Ragged(self.arrays[index]) if isinstance(index, slice) else self.arrays[index]

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, Ragged)
            and len(self) == len(other)
            and all(np.array_equal(a, b) for a, b in zip(self, other, strict=True))
        )

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"Ragged({len(self)} arrays)"
