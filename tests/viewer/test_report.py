from typing import Any

import numpy as np

from reperform.viewer.graph_svg import GraphStep, svg
from reperform.viewer.report import ReportStep, report, size


def test_the_page_carries_all_it_needs(products: dict[str, Any]) -> None:
    steps = [
        ReportStep(
            "film",
            "studio.film",
            400,
            390,
            9,
            1,
            12.5,
            2_500_000,
            "failed",
            "",
            {"a <b>": np.zeros((4, 6, 3), np.uint8)},
        ),
        ReportStep("table", "evaluate.truth", 1, 1, state="fresh", tables={"": products["table"]}),
    ]
    page = report(
        "quick & start", steps, svg([GraphStep("film", "studio.film")]), {"numpy": "2.4"}, seconds=13.0
    )
    assert "quick &amp; start" in page
    assert "a &lt;b&gt;" in page
    assert "data:image/png;base64," in page
    assert "<svg" in page
    assert 'src="http' not in page
    assert "1 of 2 measured targets held" in page
    assert all(
        word in page for word in ("✓ held", "✗ missed", "– not measured", "numpy 2.4", "2.5 MB", "1 failed")
    )


def test_size() -> None:
    assert [size(count) for count in (0, 999, 1200, 123_456_789)] == ["0 B", "999 B", "1.2 kB", "123 MB"]
