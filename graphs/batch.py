"""One batch of items of one step: what a worker does. Arrays come from and go to the store, never over the wire."""

from __future__ import annotations

import contextlib
import importlib
import sys
import time
import traceback
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from reperform.graphs.lazy import lazy_product, whole_product
from reperform.graphs.messages import Batch, Feed, ItemOutcome, Outcome
from reperform.nodes.catalogue import FieldSpec
from reperform.nodes.product import Axes, conform, flatten, unflatten
from reperform.nodes.ragged import Ragged
from reperform.storage.digest import SIZE
from reperform.storage.errors import DamagedResult, StoreError
from reperform.storage.manifest import open_unit
from reperform.storage.shelf import open_shelf
from reperform.storage.tables import digest_array, digest_table, pack_tables

READ_AHEAD = 32 << 20


def run_batch(batch: Batch) -> Outcome:
    """Compute and store a batch. Errors of items, damaged inputs and a failing store are part of the outcome."""
    try:
        function = getattr(importlib.import_module(batch.function[0]), batch.function[1])
        with _threads(batch.threads):
            return (
                _run_items(batch, function)
                if batch.over in ("frame", "view")
                else _run_whole(batch, function)
            )
    except DamagedResult as damage:
        rows = None if damage.rows is None else tuple(damage.rows)
        return Outcome(damaged=(damage.segment, rows, damage.reason))
    except StoreError as error:
        return Outcome(store_error=str(error.strerror or error))


@contextlib.contextmanager
def _threads(count: int) -> Any:
    """Hold numba and OpenCV to the declared threads, so that parallel items do not oversubscribe the machine."""
    # modules that another batch is in the midst of importing lack what is asked for here
    numba, cv2 = sys.modules.get("numba"), sys.modules.get("cv2")
    if numba and hasattr(numba, "set_num_threads"):
        numba.set_num_threads(min(count, numba.config.NUMBA_NUM_THREADS))
    if cv2 and hasattr(cv2, "setNumThreads") and cv2.getNumThreads() != 1:
        cv2.setNumThreads(1)
    yield


def _kind(name: tuple[str, str]) -> type:
    return getattr(importlib.import_module(name[0]), name[1])


def _run_items(batch: Batch, function: Any) -> Outcome:
    inputs = _Inputs(batch)
    outcome = Outcome()
    rows: list[dict[str, np.ndarray]] = []
    for position, item in enumerate(batch.items):
        result = ItemOutcome()
        arguments = inputs.of(position)
        start = time.perf_counter()
        try:
            extra = {} if item.window is None else {"centre": (item.frame or 0) - item.window[0]}
            output = function(*arguments, **batch.parameters, **extra)
            arrays, tables = _item_fields(output, batch)
        except DamagedResult:
            raise
        except Exception as error:  # whatever a node raises is reported with its item
            result.error, result.trace = f"{type(error).__name__}: {error}", traceback.format_exc()
        else:
            result.row, result.tables = len(rows), pack_tables(tables)
            rows.append(arrays)
        result.seconds = time.perf_counter() - start
        outcome.items.append(result)
    if rows:
        stacked = {name: [row[name] for row in rows] for name in batch.fields}
        outcome.segments.append(open_shelf(batch.url).write_segment(batch.node, stacked, by_item=True))
    return outcome


def _run_whole(batch: Batch, function: Any) -> Outcome:
    arguments = _Inputs(batch).of(0)
    start = time.perf_counter()
    outcome = Outcome()
    try:
        output = function(*arguments, **batch.parameters)
        products = _by_output(output, batch)
        prepared = [_whole_fields(product, batch) for product in products]
    except DamagedResult:
        raise
    except Exception as error:  # whatever a node raises is reported with its item
        failed = ItemOutcome(error=f"{type(error).__name__}: {error}", trace=traceback.format_exc())
        return Outcome(items=[failed] * len(batch.outputs or ("",)))
    seconds = time.perf_counter() - start
    for arrays, tables in prepared:
        outcome.segments.append(open_shelf(batch.url).write_segment(batch.node, arrays))
        outcome.items.append(
            ItemOutcome(pack_tables(tables), seconds / len(prepared), segment=len(outcome.segments) - 1)
        )
    return outcome


def _by_output(output: Any, batch: Batch) -> list[Any]:
    if batch.outputs is None:
        return [output]
    if not isinstance(output, Mapping) or list(output) != list(batch.outputs):
        got = list(output) if isinstance(output, Mapping) else type(output).__name__
        raise TypeError(
            f"node {batch.node} must return one product per take, {list(batch.outputs)} in this order, got {got}"
        )
    return list(output.values())


def _flat(output: Any, batch: Batch) -> dict[str, Any]:
    kind = _kind(batch.output)
    if not isinstance(output, kind):
        raise TypeError(f"node {batch.node} must return {kind.__name__}, got {type(output).__name__}")
    return flatten(output)


def _item_fields(output: Any, batch: Batch) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Arrays of one item as declared, and digests along the item axes that are left in them."""
    cut = {"frame"} if batch.over == "frame" else {"frame", "camera"}
    arrays, tables = {}, {}
    for name, value in _flat(output, batch).items():
        spec = batch.fields[name]
        left = [axis for axis in spec.axes if axis not in cut]
        arrays[name] = _checked(value, spec, left, name, batch.node)
        tables[name] = digest_table(arrays[name], sum(axis == "camera" for axis in left))
    return arrays, tables


def _whole_fields(output: Any, batch: Batch) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Arrays of a whole product: rows along the first item axis, or whole; and digests along the item axes."""
    arrays: dict[str, Any] = {}
    tables: dict[str, np.ndarray] = {}
    lengths: dict[str, tuple[int, str]] = {}
    for name, value in _flat(output, batch).items():
        spec = batch.fields[name]
        if spec.ragged:
            if not isinstance(value, Ragged):
                raise TypeError(
                    f"node {batch.node}: field {name!r} differs from frame to frame: return a Ragged, got {type(value).__name__}"
                )
            arrays[name] = [_checked(frame, spec, list(spec.axes[1:]), name, batch.node) for frame in value]
        else:
            array = _checked(value, spec, list(spec.axes), name, batch.node)
            # rows are looked up by frame (or camera); a product without frames keeps its field whole
            arrays[name] = [np.asarray(row) for row in array] if spec.items else array
        inner = len(spec.items) - 1
        tables[name] = (
            _stacked([digest_table(row, inner) for row in arrays[name]], inner)
            if spec.items
            else np.frombuffer(digest_array(arrays[name]), np.uint8)
        )
        for axis, length in zip(spec.items, tables[name].shape[:-1], strict=True):
            known, first = lengths.setdefault(axis, (length, name))
            if known != length:
                raise ValueError(
                    f"node {batch.node}: field {name!r} has {length} along {axis!r}, but {first!r} has {known}"
                )
    return arrays, tables


def _stacked(tables: list[np.ndarray], inner: int) -> np.ndarray:
    return np.stack(tables) if tables else np.zeros((0,) * (inner + 1) + (SIZE,), np.uint8)


def _checked(value: Any, spec: FieldSpec, axes: Sequence[str], name: str, node: str) -> np.ndarray:
    array = conform(value, Axes(*spec.axes, dtype=spec.dtype, unit=spec.unit), name)
    fits = array.ndim == len(axes) and all(
        not axis.isdigit() or int(axis) == length for axis, length in zip(axes, array.shape, strict=True)
    )
    if not fits:
        raise ValueError(
            f"node {node}: field {name!r} must have axes ({', '.join(axes)}), got shape {array.shape}"
        )
    return array


class _Inputs:
    """The arguments of every item of a batch; what is cut by frame is read some frames ahead."""

    def __init__(self, batch: Batch) -> None:
        self._batch = batch
        self._whole = {
            feed.port: _whole_argument(batch.url, feed) for feed in batch.feeds if not _is_cut(feed)
        }
        self._ahead: dict[str, dict[tuple[str, int, int | None], np.ndarray]] = {}
        self._constants: dict[tuple[str, str, int | None], np.ndarray] = {}

    def of(self, position: int) -> list[Any]:
        return [
            self._cut(feed, position) if _is_cut(feed) else self._whole[feed.port]
            for feed in self._batch.feeds
        ]

    def _cut(self, feed: Feed, position: int) -> Any:
        item = self._batch.items[position]
        unit = open_unit(self._batch.url, feed.manifests[0][1])
        prefix = f"{feed.part}." if feed.part else ""
        flat: dict[str, Any] = {}
        for name, spec in feed.fields.items():
            camera = item.camera if feed.by_camera and "camera" in spec.axes else None
            if "frame" not in spec.axes or not feed.by_frame:
                key = (feed.port, name, camera)
                if key not in self._constants:
                    self._constants[key] = self._constant(unit, prefix + name, spec, camera)
                flat[name] = self._constants[key]
                continue
            low, high = item.window or (item.frame or 0, (item.frame or 0) + 1)
            frames = [self._frame(feed, unit, prefix + name, k, camera, position) for k in range(low, high)]
            if item.window is None:
                flat[name] = frames[0]
            else:
                flat[name] = Ragged(frames) if spec.ragged else np.stack(frames)
        return unflatten(_kind(feed.kind), flat)

    def _constant(self, unit: Any, name: str, spec: FieldSpec, camera: int | None) -> Any:
        if "frame" not in spec.axes:
            return unit.constant(name, camera)
        arrays = unit.frames(name, range(unit.contents.lengths["frame"]), camera)
        return Ragged(arrays) if spec.ragged else np.stack(arrays)

    def _frame(
        self, feed: Feed, unit: Any, name: str, frame: int, camera: int | None, position: int
    ) -> np.ndarray:
        ahead = self._ahead.setdefault(f"{feed.port}.{name}", {})
        if (name, frame, camera) not in ahead:
            wanted = self._upcoming(position, frame, camera, feed.by_camera)
            text = unit.dtype(name).kind == "U"
            size = (
                1 if text else int(np.prod(unit.shape(name, frame), dtype=float)) * unit.dtype(name).itemsize
            )
            wanted = wanted[: max(1, READ_AHEAD // max(1, size))]
            low = self._batch.items[position].window
            keep = {key: value for key, value in ahead.items() if key[1] >= (low[0] if low else frame)}
            arrays = unit.frames(name, wanted, camera)
            self._ahead[f"{feed.port}.{name}"] = ahead = keep | {
                (name, k, camera): array for k, array in zip(wanted, arrays, strict=True)
            }
        return ahead[name, frame, camera]

    def _upcoming(self, position: int, frame: int, camera: int | None, by_camera: bool) -> list[int]:
        """Frames from `frame` on that items of this batch, from here on, will ask for."""
        frames = {frame}
        for item in self._batch.items[position:]:
            if not by_camera or camera is None or item.camera == camera:
                low, high = item.window or (item.frame or 0, (item.frame or 0) + 1)
                frames |= set(range(max(low, frame), high))
        return sorted(frames)


def _is_cut(feed: Feed) -> bool:
    return feed.many == "one" and (feed.by_frame or feed.by_camera)


def _whole_argument(url: str, feed: Feed) -> Any:
    kind = _kind(feed.kind)
    if not feed.manifests:
        return None
    if feed.many == "one":
        return whole_product(url, feed.manifests[0][1], feed.part, kind, feed.fields)
    if feed.many == "pair":
        return tuple(whole_product(url, name, feed.part, kind, feed.fields) for _, name in feed.manifests)
    products = {
        label: lazy_product(url, name, feed.part, kind, feed.fields) for label, name in feed.manifests
    }
    if feed.many == "dataset":
        return products
    return {tuple(label.split("/", 1)): product for label, product in products.items()}
