"""What every node promises, checked on all that are registered, by discovery."""

import ast
import pickle
from pathlib import Path

import numpy as np
import pytest

import reperform
from reperform.graphs.errors import RunError
from reperform.graphs.parameters import check
from reperform.graphs.pipeline import read_pipeline
from reperform.nodes.catalogue import NodeSpec, read_catalogue

ROOT = Path(__file__).parents[2]
CATALOGUE = read_catalogue()
NODES = {name: node for name, node in CATALOGUE.nodes.items() if node.module.startswith("reperform.nodes.")}
every_node = pytest.mark.parametrize("node", NODES.values(), ids=list(NODES))


@every_node
def test_defaults_are_within_bounds(node: NodeSpec):
    for parameter in node.parameters:
        if not parameter.required:
            assert check(parameter.default, parameter) == parameter.default, parameter.name


@every_node
def test_parameters_are_described(node: NodeSpec):
    assert [parameter.name for parameter in node.parameters if not parameter.about] == []


@every_node
def test_source_is_cited(node: NodeSpec):
    assert "Source:" in node.doc
    assert len(node.doc.partition("\n")[0]) < 160, "the first line is a promise, not a paragraph"


@every_node
def test_one_node_one_file_and_one_test_file(node: NodeSpec):
    station = node.module.split(".")[2]
    assert node.name == f"{station}.{node.function}"
    assert node.module == f"reperform.nodes.{station}.{node.function}"
    assert (ROOT / "tests" / "nodes" / station / f"test_{node.function}.py").is_file()


def test_every_node_pickles_as_itself():
    for node in NODES.values():
        function = node.load()
        assert pickle.loads(pickle.dumps(function)) is function


# -- imports ----------------------------------------------------------------------------------------------------

# what a layer may import of this package
LAYERS = {
    "nodes/kernels": ("nodes.kernels",),
    "nodes": ("nodes",),
    "storage": ("storage", "nodes"),
    "graphs": ("graphs", "storage", "nodes"),
    "viewer": ("viewer", "graphs", "storage", "nodes"),
}
ONLY_IN = {"zarr": "storage", "dask": "graphs", "distributed": "graphs"}
# slow to import, so never on the way of a run that does not need them
INSIDE_FUNCTIONS = ("open3d", "pyvista", "matplotlib")


def modules() -> list[Path]:
    return sorted(
        path.relative_to(ROOT)
        for layer in ("nodes", "storage", "graphs", "viewer")
        for path in (ROOT / layer).rglob("*.py")
    )


def imports(tree: ast.AST) -> list[str]:
    found = []
    for statement in ast.walk(tree):
        if isinstance(statement, ast.Import):
            found += [alias.name for alias in statement.names]
        elif isinstance(statement, ast.ImportFrom):
            found += [f"{statement.module}.{alias.name}" for alias in statement.names]
    return found


def layer_of(path: Path) -> str:
    return "nodes/kernels" if path.parts[:2] == ("nodes", "kernels") else path.parts[0]


@pytest.mark.parametrize("layer", LAYERS)
def test_imports_go_one_way(layer):
    wrong = []
    for path in modules():
        if layer_of(path) != layer:
            continue
        for name in imports(ast.parse((ROOT / path).read_text())):
            top = name.split(".")[0]
            if top == "reperform" and name != "reperform" and not name.startswith("reperform.__"):
                inside = name.removeprefix("reperform.")
                public = len(name.split(".")) == 2 and inside in reperform.__all__
                if not public and not any(
                    f"{inside}.".startswith(f"{allowed}.") for allowed in LAYERS[layer]
                ):
                    wrong.append(f"{path} imports {name}")
            elif top in ONLY_IN and layer_of(path).partition("/")[0] != ONLY_IN[top]:
                wrong.append(f"{path} imports {name}, which is for {ONLY_IN[top]}/ only")
            elif name.startswith("open3d.visualization.gui") and layer != "viewer":
                wrong.append(f"{path} imports {name}, which is for viewer/ only")
    assert wrong == []


def test_slow_libraries_are_imported_inside_functions():
    wrong = [
        f"{path} imports {name}"
        for path in modules()
        if path.parts[0] == "nodes"
        for statement in ast.parse((ROOT / path).read_text()).body
        for name in imports(statement)
        if isinstance(statement, ast.Import | ast.ImportFrom) and name.split(".")[0] in INSIDE_FUNCTIONS
    ]
    assert wrong == []


# -- pure, same answer twice, stored and read -------------------------------------------------------------------

STATIONS = ("evaluate", "similarity", "blend")


def wired(file: Path) -> str:
    """A pipeline of every node of these stations that meshes, and what others make of them, are enough for."""
    made = {NODES["capture.mesh_sequence"].output: ("mesh", "take")}
    lines = [
        f"  mesh: {{node: capture.mesh_sequence, params: {{file: {file}, first: '${{first}}', count: 5, fps: 25}}}}"
    ]
    # what measures time need not repeat itself
    todo = [node for node in NODES.values() if node.name.split(".")[0] in STATIONS and not node.volatile]
    for _ in range(4):
        for node in list(todo):
            # of several that may be left out, one: nodes that take a mesh in one form or another want exactly one
            optional = [port for port in node.ports if port.optional and port.product in made]
            needed = [port for port in node.ports if not port.optional] + optional[:1]
            fitting = all(
                port.product in made and _meets(node, port.many, made[port.product][1]) for port in needed
            )
            if needed and fitting and not any(parameter.required for parameter in node.parameters):
                step = node.name.replace(".", "_")
                inputs = ", ".join(f"{port.name}: {made[port.product][0]}" for port in needed)
                lines.append(f"  {step}: {{node: {node.name}, inputs: {{{inputs}}}}}")
                domain = "pair" if node.over == "pair" else "single" if node.over == "dataset" else "take"
                made.setdefault(node.output, (step, domain))
                todo.remove(node)
    return "takes: {low: {vars: {first: 0}}, high: {vars: {first: 5}}}\nsteps:\n" + "\n".join(lines) + "\n"


def _meets(node: NodeSpec, many: str, domain: str) -> bool:
    if node.output_many == "dataset":
        return False
    return domain in {
        "one": ("take",) if node.over in ("frame", "take") else ("single",),
        "pairs": ("pair",),
    }.get(many, ("take",))


def test_nodes_are_pure_and_repeat_themselves(tmp_path):
    time = np.arange(10)[:, None, None] / 10
    corners = np.random.default_rng(5).normal(size=(1, 12, 3)) + (0, 3, 0)
    vertices = corners * (1 + 0.2 * np.sin(2 * time + corners)) + time * (0.3, 0, 0.1)
    from scipy.spatial import ConvexHull

    hull = ConvexHull(corners[0])
    faces = hull.simplices.astype(np.int32)
    normals = np.cross(
        corners[0][faces[:, 1]] - corners[0][faces[:, 0]], corners[0][faces[:, 2]] - corners[0][faces[:, 0]]
    )
    inward = (normals * hull.equations[:, :3]).sum(axis=1) < 0
    faces[inward] = faces[inward][:, ::-1]
    used = np.unique(faces)
    faces = np.searchsorted(used, faces).astype(np.int32)
    np.savez(tmp_path / "solid.npz", vertices=vertices[:, used].astype(np.float32), faces=faces)
    (tmp_path / "p.yaml").write_text(wired(tmp_path / "solid.npz"))
    pipeline = read_pipeline(tmp_path / "p.yaml")
    assert len(pipeline.steps) > 5
    runs = []
    for store in ("first", "second"):
        # inputs are handed out read-only: a node that writes into them fails here
        try:
            runs.append(pipeline.run(store=tmp_path / store, keep_going=True))
        except RunError as error:
            pytest.fail(str(error))
    for step, placed in pipeline.steps.items():
        for unit in placed.units:
            assert runs[0].digest(step, unit) == runs[1].digest(step, unit), step
    # what is read back is checked against the digests of what the nodes returned
    for step in pipeline.steps:
        for unit in pipeline.steps[step].units:
            product = runs[0].product(step, unit)
            for name in product._fields:
                field = getattr(product, name)
                field.read() if hasattr(field, "read") else tuple(field)
