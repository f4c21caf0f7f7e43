"""From a run, or a plan, to the pages about it."""

from __future__ import annotations

from collections.abc import Sequence

from reperform.graphs.api import Run
from reperform.graphs.history import library_versions
from reperform.graphs.pipeline import Pipeline
from reperform.graphs.plan import StepPlan, plan
from reperform.nodes.products.table import Table
from reperform.storage.store import Store
from reperform.viewer.graph_svg import GraphStep, svg
from reperform.viewer.pictures.picture import overview
from reperform.viewer.report import Picture, ReportStep, report

# pictures of this many items of a step
SHOWN_ITEMS = 3


def report_page(run: Run) -> str:
    """The self-contained HTML page about a finished run."""
    store = Store(run.url)
    try:
        sizes = {name: store.index.bytes_per_item(run.pipeline.steps[name].node.name) or 0.0 for name in run}
    finally:
        store.close()
    steps = [_report_step(run, name, sizes[name]) for name in run]
    graph = svg(_graph_steps(run.pipeline, list(run), {name: "fresh" for name in run}), run.pipeline.name)
    return report(run.pipeline.name, steps, graph, library_versions(), run.pipeline.about, run.report.seconds)


def graph_page(pipeline: Pipeline, store: Store) -> str:
    """The pipeline as SVG, with what is fresh and what is stale in a store."""
    plans = plan(pipeline, store)
    states = {name: "stale" if step.stale else "fresh" for name, step in plans.items()}
    details = {name: _detail(step) for name, step in plans.items()}
    return svg(_graph_steps(pipeline, list(plans), states, details), pipeline.name)


def _detail(step: StepPlan) -> str:
    return f"{step.items} item{'' if step.items == 1 else 's'}"


def _graph_steps(
    pipeline: Pipeline, names: Sequence[str], states: dict[str, str], details: dict[str, str] | None = None
) -> list[GraphStep]:
    graph_steps = []
    for name in names:
        step = pipeline.steps[name]
        inputs = {
            port if len(wired.steps) == 1 else f"{port} ({source})": source
            + (f".{wired.part}" if wired.part else "")
            for port, wired in step.inputs.items()
            for source in wired.steps
        }
        graph_steps.append(
            GraphStep(name, step.node.name, inputs, states[name], (details or {}).get(name, ""))
        )
    return graph_steps


def _report_step(run: Run, name: str, item_bytes: float) -> ReportStep:
    step, counts = run.pipeline.steps[name], run.report.steps[name]
    pictures: dict[str, Picture] = {}
    tables: dict[str, Table] = {}
    for label in step.units[:SHOWN_ITEMS]:
        product = run.product(name, label)
        if isinstance(product, Table):
            tables[label or name] = product
        else:
            pictures[label or name] = overview(product)
    size = int(item_bytes * counts.items)
    return ReportStep(
        name, step.node.name, counts.items, counts.computed, counts.cached, counts.failed, counts.seconds, size,
        "fresh", step.about, pictures, tables,
    )  # fmt: skip
