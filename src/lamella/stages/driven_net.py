"""A net on its way, driven as the table [erection] says."""

from __future__ import annotations

from lamella.base.progress import Progress
from lamella.erection.driven_by import driven_by
from lamella.erection.erect import erect
from lamella.erection.erection import Erection
from lamella.erection.mechanism import as_mechanism
from lamella.stages.driving_devices import device_of, ground_of, nodes_near
from lamella.stages.keys import keys
from lamella.stages.stage import Upstream
from lamella.strip.lamellas import Lamellas


def driven_net(up: Upstream, lamellas: Lamellas, progress: Progress) -> Erection:
    """A whole net on its way, driven as the table [erection] says.

    Raises
    ------
    InputError
        A net that cannot be laid flat, or a driver that does not suit it.
    """
    table = up.project.erection
    assert table is not None
    network = lamellas.network
    asked = table.driver.angles
    if asked is not None:
        node = None
        with keys("erection.driver.angles", states="erection.states", lamellas="lamella"):
            if asked.at is not None:
                (node,) = nodes_near(up, network, [asked.at], "at").tolist()
            return as_mechanism(
                lamellas,
                asked.least,
                asked.most,
                node=node,
                states=table.states,
                elements=table.elements,
                progress=progress,
            )
    device = device_of(up, network)
    if device is None:
        with keys("erection", lamellas="lamella"):
            return erect(lamellas, states=table.states, elements=table.elements, progress=progress)
    ground = ground_of(up, network, table)
    read_from = {device.kind: f"erection.driver.{device.kind}", "lamellas": "lamella"}
    with keys("erection", **read_from):
        return driven_by(
            lamellas,
            device,
            states=table.states,
            elements=table.elements,
            start=table.start or ("designed" if device.kind == "radius" else "flat"),
            side=table.side,
            ground=ground,
            progress=progress,
        )
