"""What damage found in the store means for the units of a run."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from reperform.graphs.unit import Name, Unit
from reperform.storage.store import Store


class Mending:
    """Forgets damaged segments and manifests, and knows whose results lay in them."""

    def __init__(self, store: Store, units: Mapping[Name, Unit]) -> None:
        self._store, self._units = store, units
        self._broken: dict[str, set[Name]] = {}

    def forget(self, segment: str, rows: Any, reason: str) -> tuple[set[Name], list[str]]:
        """Drop a damaged segment (or `manifests/NAME`) from the index.

        Returns the units to make again: those that name it now, and those that did when it was found damaged before
        (they may have none by now); and notes for the user.
        """
        index = self._store.index
        if segment.startswith("manifests/"):
            found = [
                unit
                for unit in self._units.values()
                if any(segment.endswith(m.name) for m in unit.manifests.values())
            ]
            index.drop_manifests([m.key for unit in found for m in unit.manifests.values()])
            notes = [f"damaged manifest {segment}: {reason}; it is made again"]
        else:
            found = [unit for unit in self._units.values() if segment in self._segments(unit)]
            notes = [f"{self._store.forget(segment, rows)} ({reason})"]
            # one look at all that the input names, so that one unit is not sent back for every chunk of a bad disk
            for other in sorted({name for unit in found for name in self._segments(unit)} - {segment}):
                broken = self._store.damaged_rows(other)
                if broken != []:
                    notes.append(self._store.forget(other, broken))
        known = self._broken.setdefault(segment, set())
        known |= {unit.name for unit in found}
        return known, notes

    def _segments(self, unit: Unit) -> set[str]:
        manifests = unit.manifests.values()
        return {name for manifest in manifests for name in self._store.index.segments_of(manifest.key)}
