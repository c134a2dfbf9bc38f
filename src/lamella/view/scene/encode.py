"""A scene as bytes: one message of the studio, or base64 inside a report.

`view/assets/decode.js` reads them. Positions are float32 from the middle of what is there, so that survey coordinates
lose nothing.
"""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.wording import one_line
from lamella.view.scene.curves import Curves, Fact, Plot
from lamella.view.scene.encoding import Pack, Spec
from lamella.view.scene.frames import Frames, Motion
from lamella.view.scene.layer import InstancesLayer, Layer, LinesLayer, MeshLayer, PointsLayer, StripsLayer
from lamella.view.scene.quantity import Quantity
from lamella.view.scene.scene import Labels, Scene

SCHEMA = "lamella/scene/1"

TOLD_BEYOND = 10.0
"""How far beyond the colours values are told, in ranges of the colours: curvature has poles."""


def encode_scene(scene: Scene) -> bytes:
    """A scene as bytes; the same for the same scene.

    Returns
    -------
    bytes
        See `lamella.view.scene.encoding.Pack.whole`; the header's keys are the attributes of `Scene` and what it holds.
    """
    low, high = scene.box
    return _Encoder((low + high) / 2).scene(scene)


class _Encoder:
    def __init__(self, centre: Floats) -> None:
        self.pack = Pack()
        self.centre = centre

    def scene(self, scene: Scene) -> bytes:
        low, high = scene.box
        header = {
            "schema": SCHEMA,
            "name": one_line(scene.name),
            "centre": self.centre.tolist(),
            "origin": list(scene.origin),
            "low": (low - self.centre).tolist(),
            "high": (high - self.centre).tolist(),
            "layers": [self.layer(layer) for layer in scene.layers],
            "frames": [self.frames(one) for one in scene.frames],
            "labels": [self.labels(one) for one in scene.labels],
            "marks": [
                {"key": mark.key, "positions": self.places(mark.positions), "ids": list(mark.ids)}
                for mark in scene.marks
            ],
            "curves": [self.curves(one) for one in scene.curves],
            "remarks": [one_line(remark) for remark in scene.remarks],
        }
        return self.pack.whole(header)

    def places(self, points: Floats) -> Spec:
        return self.pack.float32(points - self.centre)

    def layer(self, layer: Layer) -> Spec:
        pack = self.pack
        told: dict[str, Any] = {"kind": layer.kind, "count": layer.count}
        for field in fields(Layer):
            value = getattr(layer, field.name)
            told[field.name] = list(value) if isinstance(value, tuple) else value
        told["owner"] = None if layer.owner is None else pack.integers(layer.owner)
        told["quantities"] = [self.quantity(one) for one in layer.quantities]
        match layer:
            case MeshLayer():
                told |= {
                    "positions": self.places(layer.positions),
                    "faces": pack.integers(layer.faces),
                    "normals": None if layer.normals is None else pack.direction16(layer.normals),
                    "like": layer.like,
                    "samples": None if layer.samples is None else pack.integers(layer.samples),
                }
            case LinesLayer():
                told |= {"positions": self.places(layer.positions), "offsets": pack.integers(layer.offsets)}
                told |= {"width": layer.width}
            case PointsLayer():
                told |= {"positions": self.places(layer.positions), "size": layer.size, "least": layer.least}
            case InstancesLayer():
                told |= {
                    "positions": pack.float32(layer.positions),
                    "faces": pack.integers(layer.faces),
                    "origins": self.places(layer.origins),
                    "axes": pack.direction16(layer.axes),
                }
            case StripsLayer():
                told |= {
                    "positions": self.places(layer.positions),
                    "normals": pack.direction16(layer.normals),
                    "offsets": pack.integers(layer.offsets),
                    "sides": pack.float32(layer.sides),
                    "sheets": len(layer.sides),
                    "height": layer.height,
                    "thickness": layer.thickness,
                    "level": layer.level,
                }
            case _:
                raise TypeError(f"no such kind of layer: {type(layer).__name__}")
        return told

    def quantity(self, quantity: Quantity) -> Spec:
        told: Spec = {key: getattr(quantity, key) for key in ("key", "label", "unit", "remark", "low", "high")}
        span = TOLD_BEYOND * (quantity.high - quantity.low)
        values = quantity.values
        if quantity.is_constant:
            values = np.full(len(values), quantity.low)
        else:
            values = np.where(np.isfinite(values), np.clip(values, quantity.low - span, quantity.high + span), np.nan)
        return told | {
            "least": quantity.least,
            "most": quantity.most,
            "stops": list(quantity.stops),
            "values": self.pack.quantised(values),
        }

    def frames(self, frames: Frames) -> Spec:
        told = {field.name: getattr(frames, field.name) for field in fields(Frames)}
        return told | {
            "values": np.asarray(frames.values, float).tolist(),
            "captions": list(frames.captions),
            "hides": list(frames.hides),
            "layers": [self.layer(layer) for layer in frames.layers],
            "motions": [self.motion(motion) for motion in frames.motions],
        }

    def motion(self, motion: Motion) -> Spec:
        pack = self.pack
        return {
            "layer": motion.layer,
            "positions": None if motion.positions is None else pack.quantised(motion.positions - self.centre),
            "displacements": None if motion.displacements is None else pack.quantised(motion.displacements),
            "normals": None if motion.normals is None else pack.direction16(motion.normals),
            "values": {key: pack.quantised(values) for key, values in motion.values.items()},
        }

    def labels(self, labels: Labels) -> Spec:
        return {
            "name": labels.name,
            "label": labels.label,
            "positions": self.places(labels.positions),
            "texts": [one_line(text) for text in labels.texts],
            "visible": labels.visible,
        }

    def curves(self, curves: Curves) -> Spec:
        pack = self.pack
        return {
            **{key: getattr(curves, key) for key in ("name", "noun", "worst", "worst_by")},
            "ids": list(curves.ids),
            **{key: pack.integers(getattr(curves, key)) for key in ("offsets", "stop_offsets", "stop_nodes")},
            "stop_samples": pack.integers(curves.stop_samples),
            "arclengths": pack.float32(curves.arclengths),
            "facts": [self.fact(one) for one in curves.facts],
            "plots": [self.plot(one) for one in curves.plots],
        }

    def fact(self, fact: Fact) -> Spec:
        values = fact.values
        told: Any = list(values) if isinstance(values, tuple) else self.pack.float32(values)
        return {"label": fact.label, "unit": fact.unit, "decimals": fact.decimals, "values": told}

    def plot(self, plot: Plot) -> Spec:
        series = [
            {"key": one.key, "label": one.label, "values": self.pack.quantised(one.values)} for one in plot.series
        ]
        return {"title": plot.title, "unit": plot.unit, "digits": plot.digits, "series": series}
