"""The command line as its users meet it: commands, help, output folders."""

from __future__ import annotations

import errno
import json
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from command.command_line import FILES, UNDULOID, contents, lamella
from lamella import __version__
from lamella.command.main import main
from lamella.project.list_tables import LIST_TABLES
from lamella.project.read import parse_project
from lamella.project.structure_tables import StructureTable
from lamella.project.tables import (
    FURTHER_TABLES,
    SURFACE_TABLES,
    BoundaryTable,
    CablesTable,
    JointTable,
    Project,
)
from messages import text_faults

COMMANDS = ("run", "new", "check", "optimise", "examples", "schema")
EXAMPLES = Path(__file__).parents[2] / "examples"


def check_told(err: str, *names: str) -> None:
    """Fail unless a refusal was printed that gives names, with its remedy and nothing of Python."""
    assert err.startswith("lamella: "), err
    assert "\n  remedy: " in err
    assert not text_faults(err), text_faults(err)
    assert all(name in err for name in names), err


# --- help, version, commands ------------------------------------------------------------------------------------


def test_help_of_everything(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(["--help"])
    assert end.value.code == 0
    told = capsys.readouterr().out
    assert all(re.search(rf"^    {command} ", told, re.M) for command in COMMANDS)
    assert "lamella run unduloid.toml" in told
    for command in COMMANDS:
        with pytest.raises(SystemExit) as end:
            main([command, "--help"])
        assert end.value.code == 0
        assert f"usage: lamella {command}" in capsys.readouterr().out


def test_run_help_lists_every_stage_and_its_files(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["run", "--help"])
    told = capsys.readouterr().out
    every, *stages = re.split(r"^  (\w+)(?:, after \w+)?$", told, flags=re.M)
    listed = dict(zip(stages[::2], stages[1::2], strict=True))
    assert list(listed) == [*FILES, "erection", "structure", "panels"]
    assert "erection/states.json" in listed.pop("erection")
    assert "structure/results.json" in listed.pop("structure")
    assert "panels.csv" in listed.pop("panels")
    for stage, files in FILES.items():
        for file in files:
            assert file in listed[stage] + (every if stage == "surface" else "")


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(["--version"])
    assert end.value.code == 0
    assert capsys.readouterr().out == f"lamella {__version__}\n"


def test_no_arguments_shows_the_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err.startswith("usage: lamella")


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        (["rnu"], "'rnu'"),
        (["run"], "project"),
        (["new"], "kind"),
        (["run", "p.toml", "--bogus"], "--bogus"),
        (["schema", "mesh"], "'mesh'"),
        (["examples", "--copy"], "--copy"),
    ],
)
def test_wrong_arguments(here: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], name: str) -> None:
    with pytest.raises(SystemExit) as end:
        main(arguments)
    assert end.value.code == 2
    told = capsys.readouterr().err
    assert name in told
    assert told.endswith("--help\n")
    assert told.count("\n") == 2


# --- new, check, examples, schema -------------------------------------------------------------------------------


HEADER = re.compile(rf"(?:# )?\[+(surface|{'|'.join([*FURTHER_TABLES, *LIST_TABLES])}|materials)\b.*?\]+")


@pytest.mark.parametrize("kind", SURFACE_TABLES)
def test_a_new_project_is_good_and_mentions_every_key(
    here: Path, capsys: pytest.CaptureFixture[str], kind: str
) -> None:
    """What `lamella new` writes passes `lamella check`, and names every key of its tables."""
    assert main(["new", kind]) == 0
    assert f"lamella run {kind}.toml" in capsys.readouterr().out
    text = (here / f"{kind}.toml").read_text()
    # comments taken off, each key stands in its table
    table, keys = "", set()
    for line in text.splitlines():
        if header := HEADER.fullmatch(line):
            table = "boundary" if "boundary" in line else header[1]
        elif key := re.match(r"(?:# *)?([a-z]\w*) =", line):
            keys.add(f"{table}.{key[1]}")
    models = {"surface": SURFACE_TABLES[kind], **FURTHER_TABLES, **LIST_TABLES}
    wanted = {f"{name}.{key}" for name, model in models.items() for key in model.model_fields}
    wanted -= {"surface.boundary"}
    assert wanted <= keys
    assert keys - wanted == OTHER_KEYS[kind == "form-found"]
    assert "[m]" in text
    assert main(["check", f"{kind}.toml"]) == 0
    checked = capsys.readouterr()
    assert checked.out.startswith(f"{kind}.toml: ")
    assert "warning" not in checked.err
    # those of surfaces that have to be found are run by tests/project/test_starter.py
    if kind not in ("form-found", "mesh"):
        assert main(["run", f"{kind}.toml", "--until", "network", "--quiet"]) == 0
        assert (here / "out" / kind / "network.json").is_file()


_OTHERS = {".name", *(f"materials.{key}" for key in ("density", "youngs_modulus", "shear_modulus", "strength"))}
# in a new project besides the keys of its tables, without and with boundary curves
OTHER_KEYS = (
    _OTHERS,
    _OTHERS | {f"boundary.{key}" for key in BoundaryTable.model_fields} - {"boundary.part", "boundary.edge_beam"},
)


@pytest.mark.parametrize("kind", SURFACE_TABLES)
def test_the_comments_of_a_new_project_are_its_defaults(
    here: Path, capsys: pytest.CaptureFixture[str], kind: str
) -> None:
    main(["new", kind, "--out", "-"])
    text = capsys.readouterr().out
    plain = tomllib.loads(text)
    # all keys active but those that exclude another, and the ones without a default
    fields = [item for model in FURTHER_TABLES.values() for item in model.model_fields.items()]
    without = {key for key, field in fields if field.default is None}
    others = "|".join({"spacing", "volume", "unit", "origin"} | without)
    uncommented = re.sub(rf"^# (?!(?:{others}) =)([a-z]\w* = )", r"\1", text, flags=re.M)
    uncommented = uncommented.replace('# [materials."my steel"]', '[materials."my steel"]')
    # tables that do something by being there are commented out as a whole; segments need a limit
    whole = {name for name in FURTHER_TABLES if Project.model_fields[name].default is None}
    headers = "|".join(whole - {"segments"})
    uncommented = re.sub(rf"^# (\[(?:{headers})\])", r"\1", uncommented, flags=re.M)
    active, given = parse_project(tomllib.loads(uncommented)), parse_project(plain)
    whole |= {"materials"}
    assert active.model_dump(exclude=whole) == given.model_dump(exclude=whole)
    assert (given.joint, given.cables, given.structure) == (None, None, None)
    assert (active.joint, active.cables, active.structure) == (JointTable(), CablesTable(), StructureTable())


def test_new_to_the_screen_and_to_other_places(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = contents(here)
    assert main(["new", "scherk", "--out", "-"]) == 0
    told = capsys.readouterr()
    assert tomllib.loads(told.out)["surface"]["kind"] == "scherk"
    assert told.err == ""
    assert contents(here) == before
    assert main(["new", "scherk", "--out", "mine.toml"]) == 0
    assert 'name = "mine"' in (here / "mine.toml").read_text()
    capsys.readouterr()
    for target, names in (("p.toml", ["p.toml", "--out"]), ("none/p.toml", ["none"]), ("p.toml/x.toml", ["p.toml"])):
        assert main(["new", "scherk", "--out", target]) == 2
        check_told(capsys.readouterr().err, *names)
    assert (here / "p.toml").read_bytes() == before["p.toml"]


@pytest.mark.parametrize(
    ("kind", "names"),
    [
        ("undoloid", ["'undoloid'", "'unduloid'"]),
        ("sphere", ["'sphere'"]),
        ("form_found", ["'form_found'", "'form-found'"]),
    ],
)
def test_new_of_an_unknown_kind(here: Path, capsys: pytest.CaptureFixture[str], kind: str, names: list[str]) -> None:
    assert main(["new", kind]) == 2
    told = capsys.readouterr().err
    check_told(told, *names)
    assert all(kind in told.partition("remedy: ")[2] for kind in SURFACE_TABLES)
    assert not (here / f"{kind}.toml").exists()


def test_examples(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    names = sorted(p.name for p in EXAMPLES.glob("*.toml"))
    assert main(["examples"]) == 0
    told = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in told[: len(names)]] == names
    assert all(len(line.split()) > 3 for line in told[: len(names)])
    assert main(["examples", "--copy", "deep/mine", "01_unduloid", "06_scherk.toml"]) == 0
    assert contents(here / "deep") == {
        f"mine/{name}": (EXAMPLES / name).read_bytes() for name in ("01_unduloid.toml", "06_scherk.toml")
    }
    capsys.readouterr()
    before = contents(here)
    for arguments, wanted in (
        (["01_undoloid", "--copy", "other"], ["01_undoloid.toml", "01_unduloid.toml"]),
        (["../p", "--copy", "other"], ["../p.toml", "01_unduloid.toml"]),
        (["--copy", "deep/mine"], ["01_unduloid.toml"]),
        (["--copy", "p.toml"], ["p.toml", "--copy"]),
        (["--copy", "p.toml/deep"], [os.strerror(errno.ENOTDIR)]),
    ):
        assert main(["examples", *arguments]) == 2
        check_told(capsys.readouterr().err, *wanted)
    assert contents(here) == before
    # with the files they name
    assert main(["examples", "--copy", "one", "16_hall"]) == 0
    assert contents(here / "one") == {name: (EXAMPLES / name).read_bytes() for name in ("16_hall.obj", "16_hall.toml")}
    assert main(["examples", "--copy", "all"]) == 0
    assert contents(here / "all") == contents(EXAMPLES)
    assert main(["examples", "--copy", "meshes", "optimise"]) == 0
    meshes = {f"optimise/{name}": data for name, data in contents(EXAMPLES / "optimise").items()}
    assert contents(here / "meshes") == meshes
    assert [line.split()[0] for line in told if line.startswith("optimise/")] == list(meshes)


# of the surfaces that have to be found, one from curves and one from a mesh
CHECKED = ("10_saddle", "16_hall")


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_examples_are_good(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = tomllib.loads(path.read_text(encoding="utf-8"))["surface"]["kind"] in ("form-found", "mesh")
    if found and path.stem not in CHECKED:
        pytest.skip("found by test_examples.py")
    assert main(["check", str(path)]) == 0
    told = capsys.readouterr()
    # one line for all, and one for what coarse elements leave to the run
    first, *left = told.out.removeprefix(f"{path}: ").splitlines()
    assert re.search(r"H = \S+ 1/m, \d+ cells, \D*[\d,]+ nodes$", first)
    assert len(left) == found
    assert found or all(line.startswith("warning: ") for line in told.err.splitlines())


def test_schema(capsys: pytest.CaptureFixture[str]) -> None:
    for which in ("project", "network", "optimise"):
        assert main(["schema", which]) == 0
        schema = json.loads(capsys.readouterr().out)
        assert schema["$id"].startswith(f"lamella/{which}/")
        assert schema["properties"]


# --- run: output folders ----------------------------------------------------------------------------------------


def test_each_stage_writes_its_files_and_replaces_the_one_before(here: Path) -> None:
    wanted: set[str] = set()
    for stage, files in FILES.items():
        wanted |= files
        assert main(["run", "p.toml", "--until", stage, "--quiet"]) == 0
        assert set(contents(here / "out" / "p")) == wanted
        summary = json.loads((here / "out" / "p" / "summary.json").read_bytes())
        stages = [*FILES, "structure"]
        assert [summary[s] is not None for s in stages] == [stages.index(s) <= stages.index(stage) for s in stages]
    # and back: nothing of the longer run stays
    assert main(["run", "p.toml", "--until", "surface", "--quiet"]) == 0
    assert set(contents(here / "out" / "p")) == FILES["surface"]
    assert sorted(p.name for p in (here / "out").iterdir()) == ["p"]


def test_without_until_all_stages_run(here: Path) -> None:
    assert main(["run", "p.toml", "--out", "o", "--quiet"]) == 0
    assert set(contents(here / "o")) == set().union(*FILES.values())


def test_progress_quiet_and_warnings(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "p.toml"]) == 0
    told = capsys.readouterr()
    assert told.out == f"report: {Path('out/p/report.html')}\n"
    for stage in FILES:
        assert re.search(rf"^{stage}: ", told.err, re.M)
    assert len(re.findall(r"\(\d+\.\d\d s\)$", told.err, re.M)) == len(FILES)
    (here / "p.toml").write_text(UNDULOID + "[lamella]\nlayers = 1\n")
    assert main(["run", "p.toml", "--quiet"]) == 0
    assert capsys.readouterr() == ("", "")
    (here / "p.toml").write_text(UNDULOID.replace("1.6", "600").replace("2.8", "1400").replace("1.0", "1000.0"))
    assert main(["run", "p.toml", "--quiet", "--until", "surface"]) == 0
    told = capsys.readouterr()
    assert told.out == ""
    assert all(line.startswith("warning: ") for line in told.err.splitlines())
    assert len(told.err.splitlines()) == 1


def test_details_are_told_only_when_asked(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    told = {}
    for word in ("", "-v", "--verbose"):
        assert main(["run", "p.toml", "--until", "surface", *word.split()]) == 0
        lines = capsys.readouterr().err.splitlines()
        told[word] = [re.sub(r"\(\d+\.\d\d s\)", "", line) for line in lines]
    assert told["-v"] == told["--verbose"]
    assert [line for line in told["-v"] if not line.startswith("    ")] == told[""]
    assert len(told["-v"]) > len(told[""])
    with pytest.raises(SystemExit) as end:
        main(["run", "p.toml", "--quiet", "-v"])
    assert end.value.code == 2
    assert "--quiet" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("until", "names"),
    [("netwrk", ["'netwrk'", "'network'"]), ("", ["''"]), ("structures", ["'structures'", "'structure'"])],
)
def test_stages_that_are_not_there(
    here: Path, capsys: pytest.CaptureFixture[str], until: str, names: list[str]
) -> None:
    assert main(["run", "p.toml", "--until", until]) == 2
    check_told(capsys.readouterr().err, "--until", *names)
    assert sorted(p.name for p in here.iterdir()) == ["p.toml"]


def test_places_that_cannot_be_written(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (here / "mine").mkdir()
    (here / "mine" / "thesis.txt").write_text("years of work")
    before = contents(here)
    for out, names in (
        ("p.toml", ["p.toml", "--out"]),
        ("p.toml/o", ["p.toml", "--out"]),
        ("p.toml/o/o", ["p.toml"]),
        ("mine", ["thesis.txt"]),
        (".", ["mine/", "p.toml"]),
        ("/", []),
        ("x" * 300, [os.strerror(errno.ENAMETOOLONG)]),
    ):
        assert main(["run", "p.toml", "--out", out]) == 2
        told = capsys.readouterr().err
        check_told(told.replace("x" * 300, "x"), *names)
        assert "area" not in told  # refused before any work
    assert contents(here) == before


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_without_the_right_to_write(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (here / "locked").mkdir(mode=0o500)
    assert main(["run", "p.toml", "--out", "locked/o"]) == 2
    check_told(capsys.readouterr().err, "locked")


def test_an_empty_folder_and_missing_parents_are_filled(here: Path) -> None:
    (here / "empty").mkdir()
    for out in ("empty", "a/b/c"):
        assert main(["run", "p.toml", "--out", out, "--until", "surface", "--quiet"]) == 0
        assert set(contents(here / out)) == FILES["surface"]


def test_the_same_input_gives_the_same_bytes(here: Path) -> None:
    for out, seed in (("a", "1"), ("b", "5")):
        done = lamella("run", "p.toml", "--out", out, "--quiet", env={**os.environ, "PYTHONHASHSEED": seed})
        assert done.wait(60) == 0
        done.communicate()
    a, b = contents(here / "a"), contents(here / "b")
    for files in (a, b):
        summary = json.loads(files.pop("summary.json"))
        assert all(s >= 0 for s in summary.pop("seconds").values())
        files["summary"] = json.dumps(summary).encode()
    assert a.keys() == b.keys()
    assert [name for name in a if a[name] != b[name]] == []


def test_odd_names(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Line breaks, quotes, markup, other scripts and length: files stay readable by their readers."""
    name = 'a\n"b"\\ </script><script>alert(1)</script> <!-- 日本 😀 \u2028 \x01' + "ü" * 100
    cleaned = 'a "b"\\ </script><script>alert(1)</script> <!-- 日本 😀 ' + "ü" * 100
    head = "name = " + json.dumps(name, ensure_ascii=False) + "\n"
    (here / "p.toml").write_text(UNDULOID.replace('name = "x"\n', head), encoding="utf-8")
    assert main(["run", "p.toml", "--quiet", "--out", "o"]) == 0
    o = here / "o"
    for file in ("summary.json", "network.json", "lamellas.json"):
        assert json.loads((o / file).read_bytes())["name"] == cleaned
    assert tomllib.loads((o / "project.toml").read_text(encoding="utf-8"))["name"] == cleaned
    for file in ("surface.obj", "network.obj"):
        kinds = {line.split(" ")[0] for line in (o / file).read_text(encoding="utf-8").split("\n") if line}
        assert kinds <= {"#", "o", "g", "v", "vn", "f", "l", "s"}, kinds
    html = (o / "report.html").read_text(encoding="utf-8")
    assert "<script>alert" not in html
    rows = [line for line in (o / "nodes.csv").read_text(encoding="utf-8").split("\n") if line]
    assert {line.count(",") for line in rows if not line.startswith("#")} == {rows[-1].count(",")}


@pytest.mark.skipif(sys.platform != "linux", reason="file names of any bytes")
def test_a_file_name_that_is_no_text(tmp_path: Path) -> None:
    path = os.fsencode(tmp_path) + b"/gr\xf6\xdfer.toml"
    with open(path, "wb") as file:
        file.write(UNDULOID.replace('name = "x"\n', "").encode())
    for arguments in ([b"check", path], [b"run", path, b"--until", b"surface"]):
        done = subprocess.run(
            [os.fsencode(sys.executable), b"-m", b"lamella", *arguments], capture_output=True, cwd=tmp_path, check=False
        )
        assert done.returncode == 0, done.stderr
    (out,) = (tmp_path / "out").iterdir()
    assert json.loads((out / "summary.json").read_bytes())["name"] == "gr��er"


def test_the_number_of_threads_does_not_change_a_byte(tmp_path: Path) -> None:
    """Of this example it does, on two cores, where OpenBLAS takes as many threads as it is allowed."""
    contents = []
    for threads in ("1", "2"):
        out = tmp_path / threads
        environment = {**os.environ, "OPENBLAS_NUM_THREADS": threads, "OMP_NUM_THREADS": threads}
        arguments = ["run", str(EXAMPLES / "10_saddle.toml"), "--until", "surface", "--out", str(out), "--quiet"]
        subprocess.run([sys.executable, "-m", "lamella", *arguments], check=True, env=environment)
        contents.append({path.name: path.read_bytes() for path in sorted(out.iterdir()) if path.suffix != ".json"})
    assert contents[0] == contents[1]
