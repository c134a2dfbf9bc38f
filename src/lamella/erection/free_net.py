"""The structural model of a net with free joints."""

from __future__ import annotations

from dataclasses import replace

from lamella.base.errors import InputError
from lamella.erection.free_body import free_body
from lamella.erection.lone_joints import lone_joints
from lamella.strip.lamellas import Lamellas
from lamella.structure.model.model import Model, make_model
from lamella.structure.model.rules import ModelRules


def free_net(lamellas: Lamellas, elements: int) -> Model:
    """A body free in space, its joints free but for those of lamellas that nothing else holds.

    Parameters
    ----------
    lamellas : Lamellas
    elements : int
        Beam elements in a cell edge.

    Raises
    ------
    InputError
        No lamella crosses another one.
    """
    network = lamellas.network
    rules = ModelRules(elements=elements, joints="hinged", slots="whole", near_design=False)
    model = make_model(lamellas, free_body(network), rules)
    if not len(model.joint_nodes):
        raise InputError("no lamella crosses another one", "a net that is erected has joints", "lamellas")
    return replace(model, structure=replace(model.structure, held_joints=lone_joints(network, model.joint_nodes)))
