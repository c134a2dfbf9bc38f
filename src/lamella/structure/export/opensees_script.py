"""The part of the OpenSees script that is the same for every structure."""

HEAD = '''\
"""{title}

Written by lamella {version}. Run it with Python and OpenSeesPy (pip install openseespy): it writes opensees.csv beside
itself, the displacements of the network's nodes in every case. Units: N, m, rad. Numbers of nodes are those of
network.json.

What OpenSees has no element for, and what stands for it:
- Residual stress of strips that were cut flat: initial strains (InitStrainMaterial) for stretch, both bendings and
  twist. The structure is held as it was designed by the forces these make, which are then taken away step by step.
- The helix effect (a twisted strip's edges are longer than its middle): each strip is a beam on its axis, which bends
  about its weak axis, twists and takes shear, and two fibres at its polar radius of gyration, on rigid arms, which
  carry axial force and strong-axis bending. What the helix stress deviates from its mean adds to torsion what grows
  with the twist and its cube, and to weak-axis stiffness; the curvature in both, which plate action and lateral
  contraction bring in, is that of the designed shape.
- Elements are straight: results converge with the square of their length. They are shorter here than in the model of
  lamella's own results: {elements} in a cell edge.
- Slots, splices: in the elements' stiffness. Rotation of joints: about the nodes' normals as designed.
- Loads along elements: as forces and moments of their ends, as designed.
- Changes of temperature: not at all, such cases are left out (LEFT_OUT). So is the play of joints.
- Cables: trusses without stiffness under compression. Where many of them go slack on the way Newton's method may find
  no equilibrium: the case is then left out, and the script says so.
"""

import csv
import math
from pathlib import Path

import openseespy.opensees as ops

'''

TAIL = '''

def material(tags, stiffness, strain=0.0, slack=False):
    """An elastic law with an initial strain; its number."""
    tag = tags["material"]
    tags["material"] += 2
    if slack:
        ops.uniaxialMaterial("Elastic", tag, stiffness, 0.0, 1e-6 * stiffness)
    else:
        ops.uniaxialMaterial("Elastic", tag, stiffness)
    ops.uniaxialMaterial("InitStrainMaterial", tag + 1, tag, strain)
    return tag + 1


def torsional(tags, stiffness, strain, constant, cubic, twist):
    """The law of torsion: elastic, and what grows with the twist and its cube; its number."""
    if not cubic:
        return material(tags, stiffness, strain)
    tag = tags["material"]
    tags["material"] += 3
    ops.uniaxialMaterial("ElasticPowerFunc", tag, "-coeff", constant, cubic, "-exp", 1.0, 3.0)
    ops.uniaxialMaterial("InitStrainMaterial", tag + 1, tag, twist)
    ops.uniaxialMaterial("Parallel", tag + 2, tag + 1, material(tags, stiffness, strain))
    return tag + 2


def next_tag(tags, kind):
    """A number that is not taken yet."""
    tags[kind] += 1
    return tags[kind] - 1


def beam(tags, one, other, upright, stations):
    """A beam element; stations of (place, weight, section)."""
    transformation, integration = next_tag(tags, "transformation"), next_tag(tags, "integration")
    ops.geomTransf("Corotational", transformation, *upright)
    places, weights, sections = zip(*stations)
    ops.beamIntegration("UserDefined", integration, len(sections), *sections, *places, *weights)
    ops.element("dispBeamColumn", next_tag(tags, "element"), one, other, transformation, integration)


def build():
    """The structure as it was designed."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    tags = dict.fromkeys(("material", "section", "transformation", "integration", "element"), 1)
    for number, point in enumerate(NODES):
        ops.node(number, *point)
    for number, held in FIXED:
        ops.fix(number, *held)
    for one, other, upright, axial, bending in ARMS:
        transformation = next_tag(tags, "transformation")
        ops.geomTransf("Corotational", transformation, *upright)
        section = (axial, 1.0, 1.0, bending, bending, bending)
        ops.element("elasticBeamColumn", next_tag(tags, "element"), one, other, *section, transformation)
    gauss = math.sqrt(0.6) / 2
    for one, other, upright, axial, torsion, strong, weak in BEAMS:
        law, twist = material(tags, *axial), torsional(tags, *torsion)
        sections = []
        for at in (0, 1):
            bent = material(tags, strong[at], strong[2]), material(tags, weak[at], weak[2])
            sections.append(next_tag(tags, "section"))
            ops.section("Aggregator", sections[-1], law, "P", bent[0], "Mz", bent[1], "My", twist, "T")
        end, middle = sections
        places = ((0.5 - gauss, 5 / 18, end), (0.5, 8 / 18, middle), (0.5 + gauss, 5 / 18, end))
        beam(tags, one, other, upright, places)
    for one, other, upright, axial, strain, little in FIBRES:
        law, soft = material(tags, axial, strain), material(tags, little)
        section = next_tag(tags, "section")
        ops.section("Aggregator", section, law, "P", soft, "Mz", soft, "My", soft, "T")
        beam(tags, one, other, upright, ((0.5, 1.0, section),))
    for one, other, axis, beside, stiffness in HINGES:
        ops.equalDOF(one, other, 1, 2, 3)
        laws = [material(tags, value) for value in stiffness]
        ops.element("zeroLength", next_tag(tags, "element"), one, other, "-mat", *laws, "-dir", 4, 5, 6,
                    "-orient", *axis, *beside)  # fmt: skip
    for one, other, axial, strain in CABLES:
        ops.element("corotTruss", next_tag(tags, "element"), one, other, 1.0, material(tags, axial, strain, slack=True))
    for number, ground, stiffness in SPRINGS:
        ops.node(ground, *NODES[number])
        ops.fix(ground, 1, 1, 1, 1, 1, 1)
        ways = [way for way, value in enumerate(stiffness, 1) if value]
        laws = [material(tags, value) for value in stiffness if value]
        ops.element("zeroLength", next_tag(tags, "element"), ground, number, "-mat", *laws, "-dir", *ways)


def hold():
    """Forces that hold the structure as it was designed; they are gone at the time 1."""
    ops.reactions()
    ops.timeSeries("Path", 1, "-time", 0.0, 1.0, 1e9, "-values", 1.0, 0.0, 0.0)
    ops.pattern("Plain", 1, 1)
    for number in ops.getNodeTags():
        forces = [ops.nodeReaction(number, way) for way in range(1, 7)]
        if any(forces):
            ops.load(number, *forces)
    ops.timeSeries("Path", 2, "-time", 0.0, 1.0, 2.0, 1e9, "-values", 0.0, 0.0, 1.0, 1.0)


def advance(name):
    """The time goes on by 1, in steps that find their own length; whether it got there."""
    done, step = 0.0, 1 / 8
    while done < 1 - 1e-12:
        step = min(step, 1 - done)
        ops.integrator("LoadControl", step)
        if ops.analyze(1) == 0:
            done += step
            step *= 2 if ops.testIter() < 6 else 1
            continue
        step /= 2
        if step < 1e-3:
            print(f"{name}: no equilibrium is found beyond the share {done:.4g}; it is left out")
            return False
    return True


def main():
    """All cases, each from the state without loads."""
    for (name,) in LEFT_OUT:
        print(f"{name}: left out, it changes the temperature, which initial strains cannot follow")
    rows = []
    for name, forces, motions in CASES:
        build()
        ops.constraints("Transformation")
        ops.numberer("RCM")
        ops.system("UmfPack")
        ops.test("NormDispIncr", 1e-9, 20, 0)
        ops.algorithm("Newton")
        hold()
        ops.integrator("LoadControl", 0.0)
        ops.analysis("Static")
        ops.analyze(1)
        found = advance(name)
        if found and (forces or motions):
            ops.pattern("Plain", 2, 2)
            for number, values in forces:
                ops.load(number, *values)
            for number, way, value in motions:
                ops.sp(number, way, value)
            found = advance(name)
        if not found:
            continue
        rows += [(name, number, *ops.nodeDisp(number)[:3]) for number in range(NETWORK_NODES)]
    with Path(__file__).with_name("opensees.csv").open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(("case", "node", "ux", "uy", "uz"))
        table.writerows((name, number, *(f"{value:.9g}" for value in shift)) for name, number, *shift in rows)


if __name__ == "__main__":
    main()
'''
