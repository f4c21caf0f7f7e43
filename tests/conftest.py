"""Fixtures shared by all tests."""

import itertools
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from reperform.nodes.products.parametric import ParametricSpace

_NUMBERS = itertools.count()


@pytest.fixture(scope="session")
def data_folder() -> Path:
    """The folder of real footage and sequences; absent it skips, and fails where CI=true."""
    folder = Path(os.environ.get("REPERFORM_DATA", Path(__file__).parents[2] / "shared" / "data"))
    if not folder.is_dir():
        reason = f"real data not found at {folder}: set REPERFORM_DATA to its folder"
        if os.environ.get("CI") == "true":
            pytest.fail(reason)
        pytest.skip(reason)
    return folder


class PlugIn:
    """A package of nodes in a folder of its own, with the entry point of an installed distribution."""

    def __init__(self, folder: Path, source: str, name: str = "demo") -> None:
        self.folder, self.name = folder, name
        folder.mkdir(parents=True, exist_ok=True)
        self.module = folder / f"{name}_nodes.py"
        self.module.write_text(source)
        info = folder / f"{name}_nodes-1.dist-info"
        info.mkdir(exist_ok=True)
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}-nodes\nVersion: 1\n")
        (info / "entry_points.txt").write_text(f"[reperform.nodes]\n{name} = {name}_nodes\n")

    def edit(self, old: str, new: str) -> None:
        """Replace text that stands once in the module."""
        source = self.module.read_text()
        assert source.count(old) == 1, f"{old!r} must stand once in {self.module}"
        self.module.write_text(source.replace(old, new))


class Command:
    """Runs `reperform` as a process of its own in a folder, with plug-ins on its path."""

    def __init__(self, folder: Path, *path: Path) -> None:
        self.folder = folder
        self.env = {
            **os.environ,
            "PYTHONPATH": os.pathsep.join([*map(str, path or (folder,)), os.environ.get("PYTHONPATH", "")]),
            "PYTHONDONTWRITEBYTECODE": "1",
            "COLUMNS": "200",
        }

    def start(self, *arguments: str) -> "subprocess.Popen[str]":
        """Start it and come back."""
        return subprocess.Popen(
            [sys.executable, "-m", "reperform.viewer.cli", *arguments],
            cwd=self.folder, env=self.env, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        )  # fmt: skip

    def __call__(self, *arguments: str, status: int = 0) -> "subprocess.CompletedProcess[str]":
        """Run it to the end; the exit status must be as said."""
        process = self.start(*arguments)
        out, err = process.communicate(timeout=120)
        assert process.returncode == status, f"exit status {process.returncode}\n{out}\n{err}"
        return subprocess.CompletedProcess(arguments, status, out, err)

    def computed(self, *arguments: str, status: int = 0) -> dict[str, int]:
        """Items computed by `run`, step by step."""
        out = self("run", *arguments, "--json", status=status).stdout
        return {name: step["computed"] for name, step in json.loads(out)["steps"].items()}


@pytest.fixture
def command(tmp_path: Path) -> Callable[..., Command]:
    """Makes the command line, run in a folder (by default `tmp_path`) that is on its path for plug-ins."""
    return lambda folder=tmp_path, *path: Command(folder, *path)


@pytest.fixture
def plug_in(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], PlugIn]:
    """Writes a plug-in from the source of its nodes and makes it importable here, under a name of its own."""

    def make(source: str) -> PlugIn:
        name = f"demo{next(_NUMBERS)}"
        made = PlugIn(tmp_path / name, source, name)
        monkeypatch.syspath_prepend(made.folder)
        return made

    return make


@pytest.fixture(scope="session")
def new_plug_in() -> Callable[[Path, str], PlugIn]:
    """Writes a plug-in called `demo` into a folder, for commands run as processes."""
    return PlugIn


@pytest.fixture(scope="session")
def new_command() -> Callable[..., Command]:
    """Makes the command line run in a folder."""
    return Command


# -- a character to direct: the virtual actor on few vertices, who walks and jumps -------------------------------


def playable_takes() -> tuple[dict, dict]:
    """Four walks by speed and turning, two jumps by height: meshes and contacts."""
    from scipy.spatial import cKDTree

    from reperform.nodes.kernels.decimate import decimate
    from reperform.nodes.products.mesh import MeshSequence
    from reperform.nodes.studio.perform import perform

    plans = {
        f"walk_{speed}_{side}": {"motion": f"turn_{side}", "walk_speed": speed, "turn": 0.8, "seconds": 2.6}
        for speed in (0.8, 1.6)
        for side in ("left", "right")
    }
    plans |= {f"jump_{h}": {"motion": "jump_high", "height": h, "seconds": 1.5} for h in (0.15, 0.4)}
    meshes, contacts, kept, faces = {}, {}, None, None
    for name, plan in plans.items():
        made = perform(costume="jacket", **plan)
        if kept is None:
            points, faces = decimate(made.mesh.vertices[0], made.mesh.faces, 700)
            kept = cKDTree(made.mesh.vertices[0]).query(points)[1]
        meshes[name] = MeshSequence(np.ascontiguousarray(made.mesh.vertices[:, kept]), faces, made.mesh.fps)
        contacts[name] = made.contacts
    return meshes, contacts


@pytest.fixture(scope="session")
def playable() -> tuple:
    """The graph walk <-> jump, and its spaces."""
    from reperform.nodes.motion_graph.parametric import parametric
    from reperform.nodes.motion_graph.space import space

    meshes, contacts = playable_takes()
    names = list(meshes)
    spaces = {
        "walk": space(
            meshes, contacts, takes=tuple(names[:4]), parameters=("speed", "turning"), blend="linear"
        ),
        "jump": space(
            meshes, contacts, takes=tuple(names[4:]), parameters=("height",), cyclic=False, blend="linear"
        ),
    }
    edges = ("walk>jump", "jump>walk")
    return parametric(spaces, edges=edges, blend="linear", subdivisions=1), spaces


@pytest.fixture(scope="session")
def circling() -> Callable[[int, float, float], ParametricSpace]:
    """Makes a space of two inputs whose top goes round once in some poses, one of them higher, from an angle on."""
    faces = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]], np.int32)
    rest = np.array([[0.1, 0, 0], [0.5, 0.2, 0], [0, 1.1, 0.3], [-0.2, 0.3, 0.4]])

    def space(poses: int, shift: float, seconds: float) -> ParametricSpace:
        """Two inputs whose top goes round once in `poses`, one of them higher; they meet the other space at one pose."""
        angle = 2 * np.pi * (np.arange(poses) / poses + shift)
        vertices = np.repeat(rest[None, None], 2, axis=0).repeat(poses, axis=1)
        vertices[:, :, 2, 0] += 0.3 * np.cos(angle)
        vertices[:, :, 2, 2] += 0.3 * np.sin(angle)
        vertices[1, :, 2, 1] += 0.2
        two = np.array([[0.0], [1.0]])
        return ParametricSpace(
            np.array(["low", "high"]), vertices.astype(np.float32), np.zeros((2, poses, 3)), np.full((2, poses), seconds / poses),
            np.zeros((2, poses, 2), bool), np.zeros((2, poses)), np.asarray(True), np.array(["height"]), np.array(["m"]),
            two * 0.2, two, np.array([[0, 1]], np.int32), np.eye(2), two * 0.2, np.zeros(1), np.full(1, 0.2),
            np.array([2], np.int32), two, np.zeros((1, 2)), np.array([-1, -1], np.int32),
            np.array([-1, -1], np.int32), np.asarray(False), faces,
            np.asarray(25, np.float32),
        )  # fmt: skip

    return space
