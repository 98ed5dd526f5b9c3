"""The package beside the command itself, and beside what is known otherwise."""

import csv
import json
import math
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import modl

EXAMPLES = Path(__file__).parents[2] / "examples"

DRIVE = """
use std.smores.Chain3
let c = Chain3()
print("bent", 30deg, 3, [1m, 2m, 3m], true, 2N * 1m)
emit(move(c.m[1].tilt, to: 30deg, in: 2s), "bend.plan.json")
"""

STUDY = """
record Row { area: Area, k: Int, word: Text, ok: Bool, maybe: Length? }
study areas(a in [1m, 2m], b in 1m..3m) by grid(b: 3) each k in 0..2 = {
  require a * b < 6m^2
  Row(area: a * b, k: k, word: "x, y", ok: k == 0, maybe: if k == 0 { 1m } else { _ })
}
study valley(x in -2.0..4) by cmaes(minimise: cost, budget: 60) = Cost(cost: (x - 1) ^ 2)
record Cost { cost: Number }
"""


@pytest.fixture
def project(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "drive.mod").write_text(DRIVE)
    (tmp_path / "study.mod").write_text(STUDY)
    return tmp_path


def test_values_are_typed(project):
    ran = modl.run("drive.mod")
    text, angle, whole, vector, truth, torque = ran.values
    assert (text, whole, truth) == ("bent", 3, True)
    assert math.isclose(angle, math.radians(30)) and angle.unit == "rad" and angle.dimension == "Angle"
    assert list(vector) == [1, 2, 3]
    assert (torque, torque.unit) == (2.0, "kg*m^2/s^2")
    assert [path.name for path in ran.written] == ["bend.plan.json"]


def test_a_plan_is_judged_sampled_and_simulated(project):
    plan = modl.run("drive.mod").plan()
    assert plan.verify().ok and plan.verify()
    series = plan.sample(rate=10)
    # The quintic without speed and acceleration at both ends, over 2 s to 30 degrees, at 10 Hz.
    [bent] = [name for name in series if np.ptp(series[name]) > 0.1]
    assert np.allclose(series.time, np.arange(21) / 10)
    s = series.time / 2
    assert np.allclose(series[bent], np.radians(30) * (10 * s**3 - 15 * s**4 + 6 * s**5), atol=1e-9)
    assert series.array.shape == (21, len(series.names)) and bent == "m[1].tilt"
    assert np.allclose(plan.sample(rate=10, series="speeds")[bent], np.gradient(series[bent], 0.1), atol=0.03)
    base = plan.sample(series="base")
    assert np.allclose(np.linalg.norm([base[q] for q in ("qw", "qx", "qy", "qz")], axis=0), 1)
    with pytest.raises(modl.ModlError, match="colours"):
        plan.sample(series="colours")
    with pytest.raises(modl.ModlError) as caught:
        plan.sample(rate=1e12)
    assert caught.value.codes == ("E0705",)
    played = plan.simulate()
    assert played["duration"] >= 2 and abs(played["fall"] or 0) == 0
    page = plan.show()
    assert "<iframe" in page._repr_html_() and page.path.read_text().lstrip().startswith("<!")


def test_errors_are_exceptions_with_diagnostics(project):
    with pytest.raises(modl.ModlError) as caught:
        modl.check(text="let a = 3m + 2s\nlet b = nowhere\n")
    assert sorted(caught.value.codes) == ["E0101", "E0201"]
    first = min(caught.value.diagnostics, key=lambda d: d.labels[0].line)
    assert first.labels[0].line == 1 and "E0201" in str(caught.value)
    with pytest.raises(modl.ModlError, match="does not exist"):
        modl.run("nothing.mod")
    (project / "bad.plan.json").write_text("{}")
    with pytest.raises(modl.ModlError):
        modl.Plan.load("bad.plan.json")
    (project / "worse.plan.json").write_text("no JSON")
    with pytest.raises(modl.ModlError, match="no plan file"):
        modl.Plan.load("worse.plan.json")
    assert modl.check(text="let a = 3m\n").warnings == ()
    assert [d.code for d in modl.check(text="let aB = 3m\n").warnings] == ["W0001"]


def test_a_study_is_a_table_of_arrays(project):
    table = modl.study("study.mod", "areas", out="sweep")
    assert len(table) == 12 and table.unit("area") == "m^2"
    a, b = table["a"], table["b"]
    assert np.array_equal(table.ok, a * b < 6)
    assert np.allclose(table["area"][table.ok], (a * b)[table.ok]) and np.isnan(table["area"][~table.ok]).all()
    assert set(table["code"]) == {"", "E0507"}
    assert np.isnan(table["maybe"][1]) and table["maybe"][0] == 1
    assert table["word"][0] == "x, y" and table["ok"][0] is True
    again = modl.Study.load("sweep/areas.csv")
    assert list(again) == list(table) and again.about["rows"] == 12
    best = modl.study("study.mod", "valley", out="sweep").best()
    assert abs(best["x"] - 1) < 0.05 and best["cost"] < 0.01
    with pytest.raises(modl.ModlError, match="seeks nothing"):
        table.best()
    pandas = pytest.importorskip("pandas")
    assert isinstance(table.to_pandas(), pandas.DataFrame)
    parquet = pytest.importorskip("pyarrow.parquet")
    table.to_parquet("areas.parquet")
    read = parquet.read_table("areas.parquet")
    assert read.column_names == list(table) and read.num_rows == 12
    types = {name: str(read.schema.field(name).type) for name in ("row", "area", "k", "word", "ok", "code")}
    assert types == {"row": "int64", "area": "double", "k": "int64", "word": "string", "ok": "bool", "code": "string"}
    assert read["area"].null_count == np.isnan(table["area"]).sum() > 0
    known = [area for area in read["area"].to_pylist() if area is not None]
    assert np.array_equal(known, table["area"][table.ok])
    assert json.loads(read.schema.metadata[b"modl"])["rows"] == 12


def test_parts_of_a_study_give_the_table_of_the_whole(project):
    whole = modl.study("study.mod", "areas", out="whole")
    assert modl.study("study.mod", "areas", out="parts", shard=(2, 2)) is None
    parts = modl.study("study.mod", "areas", out="parts", shard=(1, 2))
    assert parts.file.read_bytes() == whole.file.read_bytes()


@pytest.mark.skipif(os.name != "posix", reason="signals are those of Unix")
def test_ctrl_c_is_quick():
    program = (
        "import modl, sys\nprint('begun', flush=True)\n"
        "try:\n    modl.run(text='fn f(n: Int) -> Int = if n < 1 { 1 } else { f(n - 1) + f(n - 1) }\\nprint(f(60))\\n')\n"
        "except KeyboardInterrupt:\n    print('interrupted', flush=True)\n"
    )
    quickest = math.inf
    for _ in range(5):
        child = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
        assert child.stdout.readline() == "begun\n"
        time.sleep(0.3)
        before = time.monotonic()
        child.send_signal(signal.SIGINT)
        assert child.stdout.readline() == "interrupted\n"
        quickest = min(quickest, time.monotonic() - before)
        child.wait()
    assert quickest < 0.1


def test_cells_of_notebooks_are_programs(project, capsys):
    interactive = pytest.importorskip("IPython.core.interactiveshell")
    shell = interactive.InteractiveShell.instance()
    shell.run_line_magic("load_ext", "modl")
    ran = shell.run_cell_magic("modl", "", "print(4 * 90deg)\n")
    assert ran.values == [pytest.approx(2 * math.pi)] and "360deg" in capsys.readouterr().out
    assert shell.run_cell_magic("modl", "", "print(4 + 90deg)\n") is None
    assert "E0201" in capsys.readouterr().out
    page = shell.run_cell_magic("modl", "--show", DRIVE)
    assert page._repr_html_().startswith("<iframe")


@pytest.mark.parametrize("readme", ["python/README.md", "README.md"])
def test_the_readmes_run(project, readme):
    text = (EXAMPLES.parent / readme).read_text()
    code = text.split("```python\n")[1].split("```")[0]
    code = code.replace("../examples", "examples").replace("examples", str(EXAMPLES))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("True (")


def test_everything_is_documented():
    for name in modl.__all__:
        entry = getattr(modl, name)
        assert entry.__doc__, name
        for member, value in vars(entry).items() if isinstance(entry, type) else ():
            if not member.startswith("_") and callable(value):
                assert value.__doc__, f"{name}.{member}"
