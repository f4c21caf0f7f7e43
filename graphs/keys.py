"""The keys of the cache: node, code, canonical parameters and digests of inputs; nothing else.

A unit is one output of a step (a take, a pair or the only one); its key answers for all of its items at once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from reperform.nodes.catalogue import NodeSpec
from reperform.storage.digest import digest_bytes


def code_key(node: NodeSpec, parameters: bytes) -> bytes:
    """What node, code and parameters contribute to every key of a unit."""
    return digest_bytes(b"reperform 1", node.name.encode(), node.fingerprint.encode(), parameters)


def product_digest(summary: Mapping[str, object], part: str) -> bytes:
    """Digest of a stored product, or of the product inside it that `part` names, from its manifest's summary."""
    fields: Mapping[str, str] = summary["fields"]  # type: ignore[assignment]
    prefix = f"{part}." if part else ""
    inside = sorted((name[len(prefix) :], value) for name, value in fields.items() if name.startswith(prefix))
    return digest_bytes(*(text.encode() for pair in inside for text in pair))


def unit_key(code: bytes, ports: Sequence[tuple[str, Sequence[tuple[str, bytes]]]]) -> bytes:
    """Key of a whole unit. ports: (port, its (label, digest) pairs in order), in the order of the signature."""
    parts = [code]
    for name, inputs in ports:
        parts += [name.encode(), len(inputs).to_bytes(4, "little")]
        for label, digest in inputs:
            parts += [label.encode(), digest]
    return digest_bytes(b"unit", *parts)


def output_key(key: bytes, take: str) -> bytes:
    """Key of the output for one take of a node that gives one product per take."""
    return digest_bytes(key, take.encode())
