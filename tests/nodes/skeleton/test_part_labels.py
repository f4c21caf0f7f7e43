import json
from pathlib import Path

import numpy as np
import pytest

from reperform.nodes.skeleton.part_labels import part_labels


def test_vertices_listed_by_part(tmp_path: Path) -> None:
    (tmp_path / "marks.json").write_text(json.dumps({"hand": [4, 2], "arm": [0]}))
    labels = part_labels(file=str(tmp_path / "marks.json"), vertices=6)
    assert labels.label.tolist() == [1, -1, 0, -1, 0, -1]
    assert labels.names.tolist() == ["hand", "arm"]


def test_an_archive_of_labels(tmp_path: Path) -> None:
    np.savez(tmp_path / "a.npz", labels=np.array([1, 0, -1]), label_names=np.array(["x", "y"]))
    labels = part_labels(file=str(tmp_path / "a.npz"))
    assert labels.label.tolist() == [1, 0, -1]
    assert labels.names.tolist() == ["x", "y"]


def test_what_does_not_fit_is_refused(tmp_path: Path) -> None:
    (tmp_path / "twice.json").write_text(json.dumps({"hand": [4, 2], "arm": [2]}))
    with pytest.raises(ValueError, match="arm and hand share some"):
        part_labels(file=str(tmp_path / "twice.json"))
    (tmp_path / "far.json").write_text(json.dumps({"hand": [4, 9]}))
    with pytest.raises(ValueError, match=r"must be 0 \.\. 4"):
        part_labels(file=str(tmp_path / "far.json"), vertices=5)
    np.savez(tmp_path / "a.npz", labels=np.array([1, 2]), label_names=np.array(["x", "y"]))
    with pytest.raises(ValueError, match=r"of -1 \.\. 1"):
        part_labels(file=str(tmp_path / "a.npz"))
    with pytest.raises(ValueError, match="cannot be read"):
        part_labels(file=str(tmp_path / "none.npz"))
