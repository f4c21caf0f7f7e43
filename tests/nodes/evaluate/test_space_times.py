from reperform.nodes.blend.hybrid import hybrid
from reperform.nodes.evaluate.space_times import space_times


def test_time_memory_and_error_are_told(turning_takes):
    space = hybrid(turning_takes, place=False, epsilon=0.01, levels=2)
    value = dict(
        zip(
            *(
                x.tolist()
                for x in (space_times(space, repeats=2).name, space_times(space, repeats=2).value[0])
            ),
            strict=True,
        )
    )
    assert value["hybrid"] > 0 and value["linear"] > 0 and value["hybrid / linear"] > 0
    assert 0 < value["memory"] < 1.2
    assert value["error"] == space.error.max()


def test_a_space_without_corrections_stores_nothing(turning_takes):
    space = hybrid(turning_takes, place=False, epsilon=1.0)
    measures = space_times(space, repeats=1)
    assert measures.value[0, measures.name.tolist().index("memory")] == 0.0
