"""Envelope over cases: against the cases themselves."""

from dataclasses import replace

import numpy as np

from lamella.base.material import Material
from lamella.strip.lamellas import Section
from lamella.structure.analysis.analyse import analyse
from lamella.structure.export.further_rows import ENVELOPE, GOVERNING, envelope_of, envelope_rows, governing_rows
from lamella.structure.export.result_rows import ELEMENTS, EndForces, element_rows
from lamella.structure.model.model import make_model
from lamella.structure.model.rules import ModelRules
from structure.model.nets import PATCH, pinned_rim, pushed

STEEL = Material(7850, 210e9, 81e9, 355e6)


def analysed():
    cases = [
        replace(pushed(PATCH, force), name=name)
        for name, force in (("down", (0, 0, -20.0)), ("up", (0, 0, 30.0)), ("down again", (0, 0, -20.0)))
    ]
    model = make_model(PATCH.strips(Section(layers=1), STEEL), pinned_rim(PATCH), ModelRules(elements=1))
    return analyse(model, cases, frequencies=0, buckling=0)


def test_smallest_and_largest_of_all_cases():
    found = analysed()
    envelope = envelope_of(found.cases)
    forces = np.stack([EndForces.of(case).values for case in found.cases])
    assert np.allclose(envelope.least.values, forces.min(0), rtol=0, atol=1e-6)
    assert np.allclose(envelope.most.values, forces.max(0), rtol=0, atol=1e-6)
    use = np.stack([case.use.utilisation for case in found.cases])
    assert np.allclose(envelope.utilisation.values, use.max(0), rtol=0, atol=1e-8)
    chosen = np.take_along_axis(use, envelope.utilisation.cases[None], 0)[0]
    assert np.array_equal(chosen, envelope.utilisation.values)
    # of cases alike the first counts
    assert not np.isin(envelope.most.cases, 3).any()
    assert envelope.deflection.values.max() == max(case.deflection_max for case in found.cases)
    assert {"down", "up"} <= {envelope.names[k] for k in np.unique(envelope.utilisation.cases)}


def test_rows_are_those_of_the_elements():
    found = analysed()
    envelope = envelope_of(found.cases)
    rows = list(envelope_rows(found.model, envelope))
    assert all(len(row) == len(ENVELOPE) for row in rows)
    by_case = {
        case.name: {(row[1], row[3], row[4]): row for row in map(list, element_rows(case))} for case in found.cases
    }
    most, of = ENVELOPE.index("Mz_Nm_max"), ELEMENTS.index("Mz_Nm")
    for row in rows[::7]:
        assert by_case[row[most + 1]][row[0], row[2], row[3]][of] == row[most]
    lamellas = list(governing_rows(found.model, envelope))
    assert [row[0] for row in lamellas] == list(found.model.lamellas.network.ids)
    assert all(len(row) == len(GOVERNING) for row in lamellas)
    used = [row for row in rows if row[0] == lamellas[0][0]]
    assert float(lamellas[0][3]) == max(round(float(row[-2]), 5) for row in used)
