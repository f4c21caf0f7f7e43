"""What the framework itself costs: trivial tasks, cold, with nothing to do, and with little changed; with peers beside it.

    python benchmarks/overhead.py --json FILE [--repeat 3] [--large 100000]

1,000 tasks are 500 items through 2 steps; each task adds a number to 16 others. Every run is a process of its own: wall
seconds are those of the process, engine seconds those inside it once everything it needs is imported.
"""

from __future__ import annotations

import argparse
import importlib
import importlib.util
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

ITEMS = 500
CASES = ("cold", "no-op", "10 changed")
NODES = '''
from typing import Annotated, NamedTuple

import numpy as np

from reperform import Axes, node


class Numbers(NamedTuple):
    """Sixteen numbers a frame."""

    values: Annotated[np.ndarray, Axes("frame", "k", dtype="float64")]


@node(over="take")
def source(*, items: int = 500, changed: int = 0) -> Numbers:
    """Numbers; the first so many others than usual."""
    values = np.arange(16.0 * items).reshape(items, 16)
    values[:changed] += 0.5
    return Numbers(values)


@node(over="frame")
def a(numbers: Numbers) -> Numbers:
    """One more."""
    return Numbers(numbers.values + 1)


@node(over="frame")
def b(numbers: Numbers) -> Numbers:
    """Two more."""
    return Numbers(numbers.values + 2)
'''
PIPELINE = """
steps:
  source: {node: overhead.source}
  a: {node: overhead.a, inputs: {numbers: source}}
  b: {node: overhead.b, inputs: {numbers: a}}
"""


# -- one run of one tool, in a process of its own ---------------------------------------------------------------


def run_reperform(case: str, folder: Path, items: int) -> float:
    from reperform.viewer.cli import main

    needed = ["reperform.graphs.api", "reperform.viewer.progress"]
    if case != "no-op":
        needed += [
            "dask.threaded",
            "reperform.storage.chunk_folder",
            "reperform.graphs.complete",
            "reperform.graphs.executor",
        ]
        needed += ["reperform.graphs.item_keys", "reperform.storage.segment", "overhead_nodes"]
    for module in needed:
        importlib.import_module(module)
    sets = [f"source.items={items}", f"source.changed={_changed(case)}"]
    call = ["run", str(folder / "p.yaml"), "--store", str(folder / "store")]
    start = time.perf_counter()
    main([*call, *(part for text in sets for part in ("--set", text))], standalone_mode=False)
    return time.perf_counter() - start


def run_joblib(case: str, folder: Path, items: int) -> float:
    import joblib
    import numpy as np

    memory = joblib.Memory(folder / "joblib", verbose=0)
    values = np.arange(16.0 * items).reshape(items, 16)
    values[: _changed(case)] += 0.5
    start = time.perf_counter()
    one, two = memory.cache(_one_more), memory.cache(_two_more)
    for row in values:
        two(one(row))
    return time.perf_counter() - start


def _one_more(x: Any) -> Any:
    return x + 1


def _two_more(x: Any) -> Any:
    return x + 2


def run_hamilton(case: str, folder: Path, items: int) -> float:
    import numpy as np
    from hamilton import ad_hoc_utils, driver

    values = np.arange(16.0 * items).reshape(items, 16)
    values[: _changed(case)] += 0.5
    source = "import numpy as np\n" + "".join(
        f"def a{k}(x{k}: np.ndarray) -> np.ndarray:\n    return x{k} + 1\n"
        f"def b{k}(a{k}: np.ndarray) -> np.ndarray:\n    return a{k} + 2\n"
        for k in range(items)
    )
    module = ad_hoc_utils.module_from_source(source)
    start = time.perf_counter()
    built = driver.Builder().with_modules(module).with_cache(path=folder / "hamilton").build()
    built.execute([f"b{k}" for k in range(items)], inputs={f"x{k}": values[k] for k in range(items)})
    return time.perf_counter() - start


def _changed(case: str) -> int:
    # five items through two steps are ten tasks
    return 5 if case == "10 changed" else 0


TOOLS = {
    "reperform": ("reperform", run_reperform),
    "joblib.Memory": ("joblib", run_joblib),
    "Hamilton": ("hamilton", run_hamilton),
}


# -- all of them ------------------------------------------------------------------------------------------------


def measure(tool: str, case: str, folder: Path, items: int) -> tuple[float, float]:
    """Wall and engine seconds of one run. Raises RuntimeError where it fails."""
    env = {**os.environ, "PYTHONPATH": os.pathsep.join([str(folder), os.environ.get("PYTHONPATH", "")])}
    start = time.perf_counter()
    done = subprocess.run(
        [sys.executable, __file__, "--worker", tool, case, str(folder), str(items)],
        env=env,
        capture_output=True,
        text=True,
    )
    wall = time.perf_counter() - start
    if done.returncode:
        raise RuntimeError(f"{tool}, {case}: {done.stderr[-2000:]}")
    return wall, float(done.stdout.split()[-1])


def prepare(folder: Path) -> None:
    """A plug-in with the nodes, and the pipeline."""
    (folder / "overhead_nodes.py").write_text(NODES)
    info = folder / "overhead_nodes-1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: overhead-nodes\nVersion: 1\n")
    (info / "entry_points.txt").write_text("[reperform.nodes]\noverhead = overhead_nodes\n")
    (folder / "p.yaml").write_text(PIPELINE)


def rows(repeat: int) -> list[dict[str, Any]]:
    """Medians of all tools that are installed, case by case."""
    found = []
    times: dict[tuple[str, str], list[tuple[float, float]]] = {}
    for _ in range(repeat):
        # tool after tool within a repetition, so that a busy machine is busy for all of them
        for tool, (module, _run) in TOOLS.items():
            if importlib.util.find_spec(module) is None:
                continue
            with tempfile.TemporaryDirectory() as name:
                folder = Path(name)
                prepare(folder)
                if tool == "reperform":
                    subprocess.run(
                        [sys.executable, "-m", "reperform.viewer.cli", "nodes"], capture_output=True, check=True,
                        env={**os.environ, "PYTHONPATH": os.pathsep.join([name, os.environ.get("PYTHONPATH", "")])},
                    )  # fmt: skip
                for case in CASES:
                    times.setdefault((tool, case), []).append(measure(tool, case, folder, ITEMS))
    for (tool, case), pairs in times.items():
        wall, engine = (statistics.median(values) for values in zip(*pairs, strict=True))
        found.append({"tool": tool, "case": case, "wall_s": round(wall, 3), "engine_s": round(engine, 4)})
    return found


def large_row(items: int, repeat: int) -> dict[str, Any]:
    """Nothing to do for so many items (half of them in each of two steps)."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        prepare(folder)
        measure("reperform", "cold", folder, items // 2)
        pairs = [measure("reperform", "no-op", folder, items // 2) for _ in range(repeat)]
    wall, engine = (statistics.median(values) for values in zip(*pairs, strict=True))
    return {
        "tool": "reperform",
        "case": f"no-op of {items}",
        "wall_s": round(wall, 3),
        "engine_s": round(engine, 4),
    }


def aims(found: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The figures aimed at, and whether they hold."""
    by = {(row["tool"], row["case"]): row for row in found}
    own = {case: row for (tool, case), row in by.items() if tool == "reperform"}
    tasks = 2 * ITEMS
    listed = [
        ("no-op of 1,000, engine seconds", own["no-op"]["engine_s"], 0.1),
        ("no-op of 1,000, wall seconds", own["no-op"]["wall_s"], 0.5),
        ("10 changed, engine seconds", own["10 changed"]["engine_s"], 0.5),
        ("cold, milliseconds per task", round(own["cold"]["engine_s"] / tasks * 1000, 3), 2.0),
    ]
    listed += [
        (f"{case}, wall seconds", row["wall_s"], 2.0)
        for case, row in own.items()
        if case.startswith("no-op of")
    ]
    for case in CASES:
        if ("Hamilton", case) in by:
            for column in ("wall_s", "engine_s"):
                listed.append(
                    (f"{case}, {column} over Hamilton's", own[case][column], by["Hamilton", case][column])
                )
    return [
        {"figure": figure, "value": value, "target": target, "holds": value <= target}
        for figure, value, target in listed
    ]


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--json", metavar="FILE", help="where to write the figures (default: standard output)"
    )
    parser.add_argument("--repeat", type=int, default=3, help="runs of each case; their median counts")
    parser.add_argument(
        "--large", type=int, default=100_000, help="items of the large case (0: leave it out)"
    )
    parser.add_argument(
        "--worker", nargs=4, metavar=("TOOL", "CASE", "FOLDER", "ITEMS"), help=argparse.SUPPRESS
    )
    given = parser.parse_args()
    if given.worker:
        tool, case, folder, items = given.worker
        print(TOOLS[tool][1](case, Path(folder), int(items)))
        return
    found = rows(given.repeat)
    if given.large:
        found.append(large_row(given.large, given.repeat))
    machine = {
        "processor": platform.processor() or platform.machine(),
        "cores": os.cpu_count(),
        "system": platform.system(),
        "python": platform.python_version(),
        "load": round(os.getloadavg()[0], 2),
    }
    text = json.dumps({"machine": machine, "rows": found, "aims": aims(found)}, indent=2)
    if given.json:
        Path(given.json).write_text(text + "\n", encoding="utf-8")
    else:
        print(text)


if __name__ == "__main__":
    main()
