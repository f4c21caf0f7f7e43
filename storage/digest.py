"""Digests of bytes: what keys are made of."""

from __future__ import annotations

import hashlib

SIZE = 16


def digest_bytes(*parts: bytes) -> bytes:
    """blake2b over parts, each preceded by its length, so that no two lists of parts collide by concatenation."""
    state = hashlib.blake2b(digest_size=SIZE)
    for part in parts:
        state.update(len(part).to_bytes(8, "little"))
        state.update(part)
    return state.digest()
