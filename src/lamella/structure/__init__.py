"""Structures of lamellas: residual stress, equilibrium under loads, buckling, vibration.

Examples
--------
A strip of 2 m, 100 x 1.5 mm, is bent to a quarter circle by turning its end, and loaded there.

>>> import numpy as np
>>> from lamella import find_material
>>> from lamella.structure.beam.beams import make_beams
>>> from lamella.structure.beam.cross_section import flat_strip
>>> from lamella.structure.beam.poses import straight_poses
>>> from lamella.structure.construction import continued
>>> from lamella.structure.loads import make_loads
>>> from lamella.structure.static import equilibrium, loaded
>>> from lamella.structure.structure import make_structure
>>> from lamella.structure.vibration import vibration
>>> section = flat_strip(find_material("1.4301"), 0.1, 0.0015)
>>> beams = make_beams([[k, k + 1] for k in range(8)], 0.25, section)
>>> structure = make_structure(straight_poses(2.0, 8), beams, {0: "all", 8: "rx ry rz"})
>>> arc = equilibrium(structure, make_loads(structure, motions={8: (0, 0, 0, 0, 0, np.pi / 2)}), steps=4)
>>> arc.poses.points[-1].round(6)
array([1.27324, 1.27324, 0.     ])
>>> moment = arc.reactions[-1, 5]
>>> print(f"{moment:.3f} N m")
4.602 N m
>>> pushed = loaded(continued(arc, make_loads(structure, forces={8: (0, 3.0, 0, 0, 0, 0)})))
>>> pushed
Equilibrium(load factor 1, stable, energy 3.73718 J)
>>> vibration(pushed)
Vibration(0.5625 Hz)

The straight strip twisted by 1 rad, its end free to come nearer: by (h^2 + t^2) tg^2 / 24 of its length, 0.2084 mm. The
torque is that of Saint-Venant and that of the helix, G J tg + E t h^5 tg^3 / 360 = 4.290 + 1.042 N m.

>>> straight = make_structure(straight_poses(2.0, 8), beams, {0: "all", 8: "y z rx ry rz"})
>>> twisted = equilibrium(straight, make_loads(straight, motions={8: (0, 0, 0, 1.0, 0, 0)}), steps=2)
>>> print(f"{1e3 * (2.0 - twisted.poses.points[-1, 0]):.4f} mm, {twisted.reactions[-1, 3]:.3f} N m")
0.2084 mm, 5.332 N m
"""
