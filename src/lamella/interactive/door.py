"""The door for programs: JSON in, JSON out, on the page's server, for Rhino, Grasshopper and COMPAS.

A request holds a project as its tables, with curves and meshes as those programs have them; the answer holds what was
made, plainly, as objects of rhino3dm or as data of COMPAS. Nothing of a request touches the design that the page shows,
and no file of the machine is read.
"""

from __future__ import annotations

import base64
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import orjson

from lamella import __version__
from lamella.base.errors import InputError
from lamella.interactive.door_curves import taken_in
from lamella.interactive.one_at_a_time import computing
from lamella.project.read import parse_project
from lamella.stages.computation import compute
from lamella.stages.drawn import in_drawing
from lamella.stages.results import Results

UNTIL = {"surface": "surface", "net": "network", "strips": "lamellas", "parts": "fabrication"}
"""What can be asked for, and the last stage it takes."""

FORMS = ("plain", "rhino", "compas", "3dm")


@dataclass(frozen=True)
class Answer:
    """What a program gets."""

    status: int
    content: bytes
    type: str = "application/json"


def answer(name: str, body: bytes) -> Answer:
    """The answer to a request.

    Parameters
    ----------
    name : str
        Of `UNTIL`; "" for what the door offers.
    body : bytes
        {"project": {...}, "form": one of `FORMS`}; see docs/studio.md.
    """
    if not name:
        return Answer(200, orjson.dumps({"version": __version__, "asks": list(UNTIL), "forms": list(FORMS)}))
    if name not in UNTIL:
        return _refused(404, InputError(f"nothing is called {name[:40]!r}", f"ask for one of {', '.join(UNTIL)}"))
    try:
        return Answer(200, orjson.dumps(_made(name, body), option=orjson.OPT_SERIALIZE_NUMPY))
    except InputError as error:
        return _refused(422, error)
    except MemoryError:
        return _refused(422, InputError("not enough memory", "choose fewer cells"))


def _refused(status: int, error: InputError) -> Answer:
    told = {"message": error.message, "remedy": error.remedy, "where": error.where}
    return Answer(status, orjson.dumps({"error": told}))


def _made(name: str, body: bytes) -> dict[str, Any]:
    asked = _asked(body)
    form = asked.get("form", "plain")
    if form not in FORMS:
        raise InputError(f"form = {str(form)[:40]!r}", f"choose one of {', '.join(FORMS)}", "form")
    # curves and meshes come as files of a folder that is gone afterwards
    with tempfile.TemporaryDirectory(prefix="lamella-") as there:
        folder = Path(there)
        values = taken_in(asked["project"], folder)
        if not values:
            raise InputError("the project is empty", 'give "surface" = {"kind": "form-found", ...}', "project")
        project = parse_project(values)
        with computing:
            results = compute(project, until=UNTIL[name], folder=folder)
        summary = results.summary
        return {
            "version": __version__,
            "units": "m",
            "figures": {stage: summary[stage] for stage in UNTIL.values() if summary.get(stage)},
            "warnings": [str(warning) for warning in summary["warnings"]],
            name: WRITERS[form](name, results, folder),
        }


def _asked(body: bytes) -> Mapping[str, Any]:
    try:
        asked = orjson.loads(body)
    except orjson.JSONDecodeError as error:
        raise InputError(f"the request is no JSON: {str(error)[:120]}", "send a table in JSON") from None
    if not isinstance(asked, dict) or not isinstance(asked.get("project"), dict):
        raise InputError('the request has no table "project"', 'send {"project": {"surface": {...}, ...}}', "project")
    unknown = set(asked) - {"project", "form"}
    if unknown:
        raise InputError(f"unknown key {sorted(unknown)[0]!r}", "project and form are known", sorted(unknown)[0])
    return asked


# ---------------------------------------------------------------------------------------------- plain


def _plain(name: str, results: Results, folder: Path) -> Any:
    """Lists of numbers, the tables of network.json and lamellas.json, parts with their outlines."""
    if name == "surface":
        mesh = in_drawing(results.mesh, results.origin)
        return {
            "points": mesh.points.tolist(),
            "faces": _faces(mesh.faces.tolist()),
            "mean_curvature": mesh.mean_curvature.tolist(),
        }
    if name == "parts":
        return _parts(results)
    stage = {"net": "network", "strips": "lamellas"}[name]
    wanted = f"{stage}.json"
    from lamella.stages import all_stages

    own = next(one for one in all_stages.STAGES if one.name == stage)
    file = next(one for one in own.files(results.outputs[stage], results.upstream) if one.name == wanted)
    file.write(folder / wanted)
    return orjson.loads((folder / wanted).read_bytes())


def _faces(faces: list[list[int]]) -> list[list[int]]:
    """A triangle repeats its last corner in a mesh."""
    return [face[:3] if face[2] == face[3] else face for face in faces]


def _parts(results: Results) -> list[dict[str, Any]]:
    """Flat parts: outlines as x, y (m) and bulge of DXF's polylines, in the part's own frame."""
    assert results.parts is not None
    return [
        {
            "id": part.id,
            "family": part.family,
            "quantity": part.quantity,
            "length": part.length,
            "height": part.height,
            "thickness": part.thickness,
            "curvature": part.curvature,
            "mass": part.mass,
            "slots": part.slots.tolist(),
            "outline": part.outline.tolist(),
            "holes": part.holes.tolist(),
        }
        for part in results.parts.parts
    ]


# ---------------------------------------------------------------------------------------------- COMPAS


def _compas(name: str, results: Results, folder: Path) -> Any:
    """A `Mesh` of the surface, a `Graph` of the net; strips and parts as they are plainly."""
    from lamella.files.write.compas_graph import write_compas

    if name in ("strips", "parts"):
        return _plain(name, results, folder)
    what: Any = results.mesh if name == "surface" else results.network
    write_compas(in_drawing(what, results.origin), folder / "compas.json", name=results.project.name)
    return orjson.loads((folder / "compas.json").read_bytes())


# ---------------------------------------------------------------------------------------------- Rhino


def _archive(results: Results) -> bytes:
    from lamella.stages.write import model_of

    return model_of(results)


def _rhino(name: str, results: Results, folder: Path) -> Any:
    """The objects of model.3dm, each with its layer and name, as `CommonObject.Decode` of rhino3dm takes them."""
    if name == "surface":
        return [{"layer": "surface", "name": "", "object": _rhino_mesh(results)}]
    import rhino3dm

    model = rhino3dm.File3dm.FromByteArray(_archive(results))
    layers = {layer.Index: layer.FullPath for layer in model.Layers}
    return [
        {
            "layer": layers.get(one.Attributes.LayerIndex, ""),
            "name": one.Attributes.Name,
            "object": one.Geometry.Encode(),
        }
        for one in model.Objects
    ]


def _rhino_mesh(results: Results) -> Any:
    import rhino3dm

    mesh, drawn = rhino3dm.Mesh(), in_drawing(results.mesh, results.origin)
    for point in drawn.points.tolist():
        mesh.Vertices.Add(*point)
    for face in drawn.faces.tolist():
        mesh.Faces.AddFace(*face)
    return mesh.Encode()


def _3dm(name: str, results: Results, folder: Path) -> Any:
    """The whole of model.3dm, in base 64, as `File3dm.FromByteArray` takes it."""
    if name == "surface":
        raise InputError('form = "3dm" begins with the net', 'choose form = "rhino" for the surface', "form")
    return base64.b64encode(_archive(results)).decode()


WRITERS: dict[str, Callable[[str, Results, Path], Any]] = {
    "plain": _plain,
    "rhino": _rhino,
    "compas": _compas,
    "3dm": _3dm,
}
