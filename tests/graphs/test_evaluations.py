"""The evaluations that ship: each ends in a table with the figures that were asked for."""

from pathlib import Path

import pytest

from reperform.graphs.document import SHIPPED
from reperform.graphs.pipeline import Pipeline, read_pipeline

EVALUATIONS = sorted(path.stem for path in (SHIPPED / "evaluation").glob("*.yaml"))
FIGURES = {
    "blending": {
        "jump_pair_r1_pct": ("<=", 1.3),
        "jump_pair_r3_pct": ("<=", 0.9),
        "far_pair_r1_pct": ("<=", 5.0),
        "far_pair_r3_pct": ("<=", 1.3),
        "volume_error": ("<=", 0.005),
        "endpoint_error_m": ("<=", 1e-6),
        "nonlinear_ms_3k": ("<=", 3.0),
        "nonlinear_ms_5600": ("<=", 8.0),
        "arap_over_nonlinear": (">=", 7.0),
        "hybrid_ms_3k": ("<=", 0.2),
        "hybrid_over_linear": ("<=", 1.5),
        "memory_ratio_at_5mm": ("<=", 0.33),
    },
    "essential_graph": {
        "pairs_at_or_below_motion_graph": (">=", 1.0),
        "pairs_equal_to_complete_digraph": (">=", 1.0),
        "mean_saving_percent": ("", None),
        "edges_kept_share": ("", None),
        "demo_graph_s": ("<=", 60.0),
        "time_exponent": ("", None),
        "memory_exponent": ("", None),
    },
    "essential_motion": {
        "skate_ratio": ("<=", 0.6),
        "volume_error": ("<=", 0.01),
        "junction_acceleration_ratio": ("<=", 1.0),
        "path_rms_m": ("<=", 0.15),
        "time_error_frames": ("<=", 2.0),
        "search_speedup_vs_dfs": (">=", 10.0),
        "search_gap": ("<=", 0.02),
    },
    "joins": {
        "contact_speed_m_s": ("<=", 0.05),
        "volume_change": ("<=", 0.01),
        "join_acceleration_ratio": ("<=", 1.0),
    },
    "keyframe_grid": {
        "max_distance_error_m": ("<=", 0.05),
        "max_time_error_s": ("<=", 0.08),
        "infeasible_share": ("", None),
        "undecided_share": ("<=", 0.01),
        "mean_gap": ("<=", 0.02),
        "ms_per_target": ("<=", 10.0),
        "speedup_vs_ilp": (">=", 7.0),
        "ilp_proved_share": ("", None),
        "ilp_cost_difference": ("<=", 1e-6),
        "optimality_gap": ("<=", 0.0),
        "smoothness_m": ("<=", 0.04),
    },
    "pose_metric": {
        "spearman_metric": ("", None),
        "spearman_vertex": ("", None),
        "metric_beats_vertex": (">=", 1.0),
        "spearman_approximation": (">=", 0.995),
        "speedup_approximation": (">=", 20.0),
    },
    "quickstart": {
        "hull_volume_over_ideal": ("<=", 1.05),
        "surface_error_mm": ("<=", 12.0),
        "correspondence_error_mm": ("<=", 25.0),
        "swap_rate": ("<=", 0.0),
        "path_distance_error_m": ("<=", 0.05),
        "path_time_error_s": ("<=", 0.08),
        "heldout_psnr_db": (">=", 24.0),
    },
    "real": {
        "surrey_iou_min": (">=", 0.85),
        "surrey_iou_mean": (">=", 0.90),
        "surrey_height_m": ("", None),
        "surrey_heldout_psnr_db": ("", None),
        "utrecht_iou_mean": (">=", 0.95),
        "utrecht_height_m": ("", None),
        "utrecht_frames": (">=", 200.0),
        "samba_join_acceleration_ratio": ("<=", 1.0),
    },
    "runtime": {
        "hz_median": (">=", 200.0),
        "frame_p99_ms": ("<=", 10.0),
        "hybrid_hz_median": (">=", 200.0),
        "hybrid_frame_p99_ms": ("<=", 10.0),
        "latency_max_s": ("<=", 1.2),
        "dead_states": ("<=", 0.0),
        "crowd10_hz": (">=", 25.0),
        "parameter_error": ("<=", 0.02),
        "contact_speed_m_s": ("<=", 0.05),
        "contact_speed_p99_m_s": ("<=", 0.05),
        "path_max_error_m": ("<=", 0.15),
    },
    "similarity_measures": {
        "precision_gain_6d_over_3d": (">=", 0.2),
        "matrix_6d_s": ("<=", 300.0),
        "spearman_vs_exact_emd": (">=", 0.99),
        "top4_agreement": (">=", 1.0),
        "speedup_vs_exact": (">=", 1000.0),
        "matrix_3d_1500_s": ("<=", 10.0),
        "transition_ms_per_pair": ("<=", 5.0),
    },
    "transition_latency": {
        "search_ms_depth10": ("<=", 0.1),
        "online_latency_over_precomputed": ("<=", 0.6),
        "online_cost_over_precomputed": ("<=", 1.1),
    },
    "transition_similarity": {
        "avg_error_2sub": ("<=", 0.6),
        "max_error_2sub": ("<=", 1.7),
        "online_ms": ("<=", 1.0),
        "online_speedup_vs_exact": (">=", 10000.0),
        "offline_s": ("<=", 10.0),
        "bound_violations": ("<=", 0.0),
    },
}


def read(name: str, data: Path) -> Pipeline:
    return read_pipeline(f"evaluation/{name}", [f"data={data}"])


@pytest.mark.parametrize("name", EVALUATIONS)
def test_an_evaluation_ends_in_a_table(name, data_folder):
    pipeline = read(name, data_folder)
    assert pipeline.steps["table"].node.output.endswith(".Table")
    assert list(pipeline.steps)[-1] == "table"


@pytest.mark.parametrize("name", FIGURES)
def test_its_rows_are_the_figures_asked_for_with_their_targets(name, data_folder):
    pipeline = read(name, data_folder)
    rows = [pipeline.steps[step].parameters("") for step in pipeline.steps["table"].inputs["figures"].steps]
    stated = {row["figure"]: (row["side"], row["target"]) for row in rows}
    assert {figure: stated.get(figure) for figure in FIGURES[name]} == FIGURES[name]


def test_footage_that_is_missing_is_told_of(monkeypatch, tmp_path):
    monkeypatch.setenv("REPERFORM_DATA", str(tmp_path / "nowhere"))
    with pytest.raises(ValueError, match=r"REPERFORM_DATA names .*nowhere"):
        read_pipeline("evaluation/real")
