"""Golden keys: whoever changes what keys are made of makes every stored result of every user stale, and must mean to."""

import numpy as np

from reperform.graphs.item_keys import SlicedPort, item_keys
from reperform.graphs.keys import code_key, product_digest, unit_key
from reperform.graphs.parameters import canonical
from reperform.nodes.catalogue import NodeSpec
from reperform.storage.manifest import Contents
from reperform.storage.tables import digest_array, digest_table

NODE = NodeSpec(
    "station.node", "package.module", "node", "", "frame", (0, 0), False, 0.5, 1, (), (), "package.Product", "one",
    {"package.module:node": "0123456789abcdef"},
)  # fmt: skip

UNIT = "86499ac2f7c59901cde77338b6d81f4f"
FRAME = "0d2e63446da5177b3b53dfff3034494a"
WINDOW = "70a5b571fb484512f5a5db59176fb078"
VIEW = "c5e40ac52e3d06be8f8517f9c6f02f52"


def code() -> bytes:
    return code_key(NODE, canonical({"voxel": 0.01, "name": "Ä", "sides": [1, 2], "deep": None}))


def contents() -> Contents:
    values = np.arange(24, dtype=np.float32).reshape(3, 2, 4)
    tables = {
        "values": digest_table(values, 2),
        "rate": np.frombuffer(digest_array(np.float32(25)), np.uint8),
    }
    axes = {"values": ("frame", "camera"), "rate": ()}
    zeros = np.zeros(3, np.int32)
    return Contents("frame", axes, {"frame": 3, "camera": 2}, tables, ["s"], zeros, zeros)


def test_golden_unit_key():
    product = product_digest(contents().summary(), "")
    assert unit_key(code(), [("port", [("", product)]), ("none", [])]).hex() == UNIT


def test_golden_item_keys():
    port = SlicedPort("port", contents(), "", True, False)
    assert item_keys(code(), [port], [], 3, None, (0, 0))[1].hex() == FRAME
    assert item_keys(code(), [port], [], 3, None, (1, 1))[1].hex() == WINDOW
    view = SlicedPort("port", contents(), "", True, True)
    assert item_keys(code(), [view], [], 3, 2, (0, 0))[3].hex() == VIEW


def test_canonical_parameters_do_not_depend_on_spelling():
    assert canonical({"b": 1.0, "a": [1]}) == canonical({"a": [1], "b": 1.0}) == b'{"a":[1],"b":1.0}'


def test_keys_of_views_hold_only_their_own_slices():
    whole = contents()
    other = np.array(whole.tables["values"])
    other[1, 0] ^= 1
    changed = Contents(
        "frame", whole.axes, whole.lengths, {**whole.tables, "values": other}, ["s"], whole.segment, whole.row
    )
    before, after = (
        item_keys(code(), [SlicedPort("port", c, "", True, True)], [], 3, 2, (0, 0)) for c in (whole, changed)
    )
    assert [a == b for a, b in zip(before, after, strict=True)] == [True, True, False, True, True, True]
