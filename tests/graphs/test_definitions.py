"""Pipelines as written: what each key means, and what is refused with file, line, what was expected, the nearest name."""

import json

import jsonschema
import pytest
import yaml

from reperform.graphs.errors import DefinitionError
from reperform.graphs.file_schema import file_schema
from reperform.graphs.pipeline import read_pipeline
from reperform.nodes.catalogue import read_catalogue

NODES = '''
from typing import Annotated, Literal, NamedTuple
import numpy as np
from reperform import Axes, Dataset, File, Pair, Pairs, Param, node


class Numbers(NamedTuple):
    values: Annotated[np.ndarray, Axes("frame", "k", dtype="float64")]


class One(NamedTuple):
    value: Annotated[np.ndarray, Axes(dtype="float64")]


class Both(NamedTuple):
    numbers: Numbers
    one: One


@node(over="take")
def source(*, count: Annotated[int, Param("1", 1, 100, "frames")] = 4, name: str = "") -> Numbers:
    """Numbers."""


@node(over="take")
def both(*, kind: Literal["plain", "fancy"] = "plain") -> Both:
    """Two products."""


@node(over="frame")
def shift(numbers: Numbers, *, by: Annotated[float, Param("m", 0, 10, "how far")] = 1.0,
          each: list[float] = [], turn: Annotated[float, Param("rad")] = 0.0, loud: bool = False) -> Numbers:
    """Shifted."""


@node(over="pair")
def distance(numbers: Pair[Numbers]) -> One:
    """Of two."""


@node(over="dataset")
def most(ones: Pairs[One]) -> One:
    """Of all pairs."""


@node(over="dataset")
def total(numbers: Dataset[Numbers]) -> One:
    """Of all."""


@node(over="take")
def read(*, file: Annotated[str, File("numbers")]) -> Numbers:
    """From a file."""
'''


@pytest.fixture
def read(plug_in, tmp_path):
    """Reads a pipeline whose nodes are those above, called `demo.`; other files may lie beside it."""
    name = plug_in(NODES).name

    def read(text: str, *sets: str, **beside: str):
        for file, content in beside.items():
            (tmp_path / f"{file}.yaml").write_text(content.replace("demo.", f"{name}."))
        path = tmp_path / "p.yaml"
        path.write_text(text.replace("demo.", f"{name}."))
        return read_pipeline(path, sets)

    return read


STEPS = "steps:\n  n: {node: demo.source}\n"
SHIFT = STEPS + "  s: {node: demo.shift, inputs: {numbers: n}}\n"
BOTH = "steps:\n  b: {node: demo.both}\n  s: {node: demo.shift, inputs: {numbers: b}}\n"
RING = SHIFT.replace("numbers: n", "numbers: t") + "  t: {node: demo.shift, inputs: {numbers: s}}\n"
TAKES_AS_PAIRS = """takes: [a, b]
steps:
  n: {node: demo.both}
  m: {node: demo.most, inputs: {ones: n.one}}
"""
BAD = {
    "cut off": ("steps:\n  n: {node: demo.sou", 2, "not YAML"),
    "no mapping": ("- a\n- b\n", 1, "mapping with the key `steps`"),
    "no steps": ("about: nothing\n", 1, "at least one step"),
    "unknown key": (STEPS + "exprots: {}\n", 3, "did you mean 'exports'?"),
    "unknown key of a step": ("steps:\n  n:\n    nod: demo.source\n", 3, "did you mean 'node'?"),
    "key twice": (STEPS + "  n: {node: demo.source}\n", 3, "'n' stands twice"),
    "unknown node": ("steps:\n  n: {node: demo.suorce}\n", 2, "did you mean"),
    "no node": ("steps:\n  n: {about: none}\n", 2, "`node` is missing"),
    "unknown step": (SHIFT.replace("numbers: n", "numbers: m"), 3, "no step 'm'"),
    "unknown port": (SHIFT.replace("numbers: n", "number: n"), 3, "did you mean 'numbers'?"),
    "dangling": (STEPS + "  s: {node: demo.shift}\n", 3, "is not wired; a step that gives one: n"),
    "wrong port type": (STEPS + "  t: {node: demo.most, inputs: {ones: n}}\n", 3, "must be One, but 'n' gives Numbers"),
    "no such part": (SHIFT.replace("numbers: n", "numbers: n.values"), 3, "has no output 'values'"),
    "part needed": (BOTH, 3, "did you mean 'b.numbers'?"),
    "cycle": (RING, 3, "cycle: s -> t -> s"),
    "unknown parameter": (SHIFT.replace("}}\n", "}, params: {buy: 1}}\n"), 3, "did you mean 'by'?"),
    "out of bounds": (SHIFT.replace("}}\n", "}, params: {by: 11}}\n"), 3, "must be within 0 .. 10 m, got 11"),
    "wrong type": (SHIFT.replace("}}\n", "}, params: {by: far}}\n"), 3, "must be a number in m, got 'far'"),
    "wrong unit": (SHIFT.replace("}}\n", "}, params: {by: 3 s}}\n"), 3, "wrong unit: must be in m"),
    "unknown unit": (SHIFT.replace("}}\n", "}, params: {by: 3 feet}}\n"), 3, "unknown unit 'feet'"),
    "no boolean": (SHIFT.replace("}}\n", "}, params: {loud: yes}}\n"), 3, "must be true or false"),
    "no list": (SHIFT.replace("}}\n", "}, params: {each: 3}}\n"), 3, "must be a list"),
    "no choice": ("steps:\n  b: {node: demo.both, params: {kind: fancier}}\n", 2, "did you mean 'fancy'?"),
    "no whole number": ("steps:\n  n: {node: demo.source, params: {count: 2.5}}\n", 2, "must be a whole number"),
    "missing file": ("steps:\n  r: {node: demo.read, params: {file: gone.txt}}\n", 2, "no file or folder 'gone.txt'"),
    "unset": ("steps:\n  r: {node: demo.read}\n", 2, "has no default and is not set"),
    "unknown variable": ("vars: {long: 3}\n" + STEPS.replace("}", ", params: {count: '${lang}'}}"), 3, "did you mean 'long'?"),
    "unknown take": ("takes: [walk, jog]\nsteps:\n  n: {node: demo.source, takes: [wall]}\n", 3, "did you mean 'walk'?"),
    "unknown item": ("takes: [walk, jog]\n" + SHIFT.replace("numbers: n", "numbers: n/wlak"), 4, "did you mean 'walk'?"),
    "take sets unknown step": ("takes: {walk: {params: {m: {count: 3}}}}\n" + STEPS, 1, "unknown step 'm'"),
    "take sets unknown parameter": ("takes:\n  walk: {params: {n: {cuont: 3}}}\n" + STEPS, 2, "did you mean 'count'?"),
    "empty takes": ("takes: []\n" + STEPS, 1, "list is empty"),
    "glob of nothing": ("takes: 'nowhere/*.obj'\n" + STEPS, 1, "nothing matches"),
    "matrix of one": ("matrix: {v: 3}\n" + STEPS, 1, "list of values"),
    "empty matrix": ("matrix: {v: []}\n" + STEPS, 1, "list of values"),
    "include of nothing": ("include: gone\n" + STEPS, 1, "no pipeline 'gone'"),
    "include itself": ("include: p.yaml\n" + STEPS, 1, "includes itself"),
    "export of nothing": (STEPS + "exports: {a.csv: m}\n", 3, "no step 'm'"),
    "bad reference": (SHIFT.replace("numbers: n", "numbers: '!'"), 3, "expected STEP, STEP.FIELD or STEP/TAKE"),
    "pairs as takes": (TAKES_AS_PAIRS, 4, "wants one product per pair"),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_refused_with_line_and_cure(read, tmp_path, case):
    text, line, told = BAD[case]
    with pytest.raises(DefinitionError) as caught:
        read(text)
    assert told in str(caught.value)
    assert str(caught.value).startswith(f"{tmp_path / 'p.yaml'}:{line}: ")


@pytest.mark.parametrize(
    ("override", "told"),
    [
        ("m.by=1", "no step 'm'"), ("s.buy=1", "did you mean 'by'?"), ("s.by=12", "within 0 .. 10"),
        ("lang=3", "no variable"), ("s.by", "expected"),
    ],
)  # fmt: skip
def test_bad_overrides_name_themselves(read, override, told):
    with pytest.raises(DefinitionError, match="--set") as caught:
        read(SHIFT, override)
    assert told in str(caught.value)


def test_quantities_with_units(read):
    params = "}, params: {by: 20 cm, turn: 180 deg, each: [1, 2.5]}}\n"
    step = read(SHIFT.replace("}}\n", params)).steps["s"]
    assert step.parameters("take") == {
        "by": 0.2,
        "turn": 3.141592653589793,
        "each": [1.0, 2.5],
        "loud": False,
    }
    assert read(SHIFT, "s.by=5 mm").steps["s"].parameters("take")["by"] == 0.005


def test_variables(read, monkeypatch):
    monkeypatch.setenv("DEMO_NAME", "from outside")
    text = """
vars: {long: 7, title: "${long} frames"}
steps:
  n: {node: demo.source, params: {count: "${long}", name: "${title}"}}
  m: {node: demo.source, params: {name: "${env.DEMO_NAME}, ${env.DEMO_NOTHING:else}"}}
"""
    steps = read(text).steps
    assert steps["n"].parameters("take") == {"count": 7, "name": "7 frames"}
    assert steps["m"].parameters("take")["name"] == "from outside, else"
    assert read(text, "long=9").steps["n"].parameters("take") == {"count": 9, "name": "9 frames"}


def test_include_with_overrides(read):
    base = "vars: {long: 3}\nsteps:\n  n: {node: demo.source, params: {count: '${long}', name: base}}\n"
    text = "include: {pipeline: base.yaml, vars: {long: 5}}\nsteps:\n  n: {params: {name: own}}\n"
    assert read(text, base=base).steps["n"].parameters("take") == {"count": 5, "name": "own"}


def test_matrix_multiplies_what_stands_on_it(read):
    text = """
matrix: {far: [1, 2], long: [3, 4]}
steps:
  n: {node: demo.source, params: {count: "${long}"}}
  s: {node: demo.shift, inputs: {numbers: n}, params: {by: "${far}"}}
  plain: {node: demo.source}
  all: {node: demo.total, inputs: {numbers: "s[*]/take"}}
"""
    pipeline = read(text)
    assert list(pipeline.steps) == [
        "n[long=3]", "n[long=4]", "s[far=1,long=3]", "s[far=1,long=4]", "s[far=2,long=3]", "s[far=2,long=4]", "plain", "all",
    ]  # fmt: skip
    assert pipeline.steps["s[far=2,long=3]"].inputs["numbers"].step == "n[long=3]"
    gathered = dict(pipeline.steps["all"].inputs["numbers"].gather)
    assert gathered["far=2,long=4"] == "s[far=2,long=4]"
    assert pipeline.chosen(["s"]) == list(pipeline.steps)[:6]
    assert list(read(text, "far=5", "long=[3]").steps) == ["n[long=3]", "s[far=5,long=3]", "plain", "all"]


def test_takes_and_their_parameters(read):
    text = """
takes:
  walk: {vars: {long: 5}}
  jog: {params: {s: {by: 2}}, vars: {long: 6}}
steps:
  n: {node: demo.source, params: {count: "${long}", name: "${take}"}}
  s: {node: demo.shift, inputs: {numbers: n}}
  first: {node: demo.shift, inputs: {numbers: n/walk}}
  some: {node: demo.shift, inputs: {numbers: n}, takes: [jog]}
  d: {node: demo.distance, inputs: {numbers: n}}
  t: {node: demo.total, inputs: {numbers: n}}
"""
    steps = read(text).steps
    assert steps["n"].parameters("jog") == {"count": 6, "name": "jog"}
    assert [steps["s"].parameters(take)["by"] for take in ("walk", "jog")] == [1.0, 2.0]
    assert steps["first"].units == ("",)
    assert steps["some"].units == ("jog",)
    assert steps["d"].units == ("walk/walk", "walk/jog", "jog/walk", "jog/jog")
    assert steps["t"].units == ("",)


def test_takes_by_glob(read, tmp_path):
    for name in ("b", "a"):
        (tmp_path / f"{name}.txt").write_text("1")
    pipeline = read(
        f"takes: '{tmp_path}/*.txt'\nsteps:\n  r: {{node: demo.read, params: {{file: '${{path}}'}}}}\n"
    )
    assert pipeline.takes == ("a", "b")
    assert pipeline.steps["r"].parameters("b")["file"] == str(tmp_path / "b.txt")


def test_schema_takes_what_is_right_and_refuses_what_is_not(read, plug_in):
    read(STEPS)
    schema = file_schema(read_catalogue())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    name = next(
        node for node in schema["$defs"]["step"]["properties"]["node"]["enum"] if node.startswith("demo")
    )
    right = yaml.safe_load(SHIFT.replace("demo.", name.partition(".")[0] + "."))
    validator.validate(right)
    wrong = json.loads(json.dumps(right))
    wrong["steps"]["s"]["params"] = {"by": 20}
    assert list(validator.iter_errors(wrong))
