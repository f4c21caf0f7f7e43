"""The thesis' XML file of a 4D parametric motion graph: nodes, their sequences, offsets and rotations."""

from __future__ import annotations

from typing import NamedTuple
from xml.parsers import expat
from xml.sax.saxutils import escape

# how a sequence without root rotations is marked
NO_ROTATION = "NO"
_LISTS = {"sequences": "sequence", "offsets": "offset", "rotations": "rotation"}


class SequenceFiles(NamedTuple):
    """One captured sequence: folder of its meshes, file of its root offsets, file of its root rotations.

    offset: "" where the file lists none; rotation: None for a straight motion (`NO`, or none listed).
    """

    meshes: str
    offset: str = ""
    rotation: str | None = None


GraphFile = tuple[tuple[SequenceFiles, ...], ...]


class GraphFileError(ValueError):
    """An XML file that does not describe a motion graph."""


class _Open(NamedTuple):
    tag: str
    line: int


def read_graph_xml(text: str, name: str = "motion graph") -> GraphFile:
    """The nodes of a 4D parametric motion graph, each the files of its sequences, from the text of an XML file.

    name: what errors call the file. Transitions are not part of the format: they are found while playing.

    Raises GraphFileError with the line where the text is no XML, a tag stands where it may not, is empty, or a
    node's lists differ in length.

    Source: 004 appendix B.1, fig B.1.
    """
    reader = _Reader(name)
    parser = expat.ParserCreate()
    parser.StartElementHandler = lambda tag, _: reader.start(tag, parser.CurrentLineNumber)
    parser.EndElementHandler = lambda tag: reader.end(parser.CurrentLineNumber)
    parser.CharacterDataHandler = reader.text
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        problem = expat.errors.messages[error.code]
        raise GraphFileError(
            f"{name}, line {error.lineno}: must be well-formed XML, got: {problem}"
        ) from error
    if not reader.nodes:
        raise GraphFileError(f"{name}, line 1: <nodes> must hold at least one <node>")
    return tuple(reader.nodes)


class _Reader:
    """What has been read so far."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.nodes: list[tuple[SequenceFiles, ...]] = []
        self._open: list[_Open] = []
        self._lists: dict[str, list[str]] = {}
        self._text = ""

    def start(self, tag: str, line: int) -> None:
        inside = self._open[-1].tag if self._open else ""
        self._no_text(inside, line)
        allowed = {"": ["nodes"], "nodes": ["node"], "node": list(_LISTS)}.get(inside)
        if allowed is None:
            allowed = [_LISTS[inside]] if inside in _LISTS else []
        if tag not in allowed:
            where = f"in <{inside}>" if inside else "at the top"
            wanted = " or ".join(f"<{one}>" for one in allowed) or "only text"
            raise GraphFileError(f"{self.name}, line {line}: {where} stands {wanted}, got <{tag}>")
        if tag in _LISTS and tag in self._lists:
            raise GraphFileError(f"{self.name}, line {line}: a node has one <{tag}>, got a second")
        if tag == "node":
            self._lists = {}
        elif tag in _LISTS:
            self._lists[tag] = []
        self._open.append(_Open(tag, line))
        self._text = ""

    def text(self, text: str) -> None:
        self._text += text

    def end(self, line: int) -> None:
        tag, opened = self._open.pop()
        written, self._text = self._text.strip(), ""
        if tag in _LISTS.values():
            if not written:
                raise GraphFileError(
                    f"{self.name}, line {line}: <{tag}> must name a file or folder, got nothing"
                )
            self._lists[self._open[-1].tag].append(written)
        elif written:
            self._no_text(tag, line, written)
        if tag == "node":
            self.nodes.append(self._node(opened))

    def _no_text(self, tag: str, line: int, written: str = "") -> None:
        if written := written or self._text.strip():
            raise GraphFileError(f"{self.name}, line {line}: <{tag}> holds tags only, got {written[:40]!r}")

    def _node(self, line: int) -> tuple[SequenceFiles, ...]:
        meshes = self._lists.get("sequences", [])
        if not meshes:
            raise GraphFileError(
                f"{self.name}, line {line}: a node needs <sequences> with at least one <sequence>"
            )
        for tag in ("offsets", "rotations"):
            if tag in self._lists and len(self._lists[tag]) != len(meshes):
                raise GraphFileError(
                    f"{self.name}, line {line}: a node has as many {tag} as sequences, {len(meshes)}, "
                    f"got {len(self._lists[tag])}"
                )
        offsets = self._lists.get("offsets", [""] * len(meshes))
        rotations = self._lists.get("rotations", [NO_ROTATION] * len(meshes))
        return tuple(
            SequenceFiles(mesh, offset, None if turn == NO_ROTATION else turn)
            for mesh, offset, turn in zip(meshes, offsets, rotations, strict=True)
        )


def write_graph_xml(graph: GraphFile) -> str:
    """The XML text of a graph; `read_graph_xml` gives the graph back.

    Raises GraphFileError where a node has no sequence, or only some of its sequences have offsets.
    """
    lines = ['<?xml version="1.0"?>', "<nodes>"]
    for number, node in enumerate(graph, 1):
        offsets = [sequence.offset for sequence in node]
        if not node or any(offsets) != all(offsets):
            problem = "has none" if not node else "has offsets for some only"
            raise GraphFileError(f"node {number} needs sequences, all or none with offsets; it {problem}")
        lines.append("  <node>")
        lines += _listed("sequences", [sequence.meshes for sequence in node])
        if all(offsets):
            lines += _listed("offsets", offsets)
        lines += _listed("rotations", [sequence.rotation or NO_ROTATION for sequence in node])
        lines.append("  </node>")
    return "\n".join([*lines, "</nodes>", ""])


def _listed(tag: str, entries: list[str]) -> list[str]:
    one = _LISTS[tag]
    return [f"    <{tag}>", *(f"      <{one}>{escape(entry)}</{one}>" for entry in entries), f"    </{tag}>"]
