"""Columns of the sheets of SAF 2.2.0 that are written, in the order of its documentation.

Source: https://github.com/StructuralAnalysisFormat/StructuralAnalysisFormat-Doc, version 2.2.0. Lengths in m,
sections in mm, forces in kN, stiffness of springs in MN/m and MNm/rad, E and G in MPa.
"""

from __future__ import annotations

VERSION = "2.2.0"

_WAYS = ("ux", "uy", "uz", "fix", "fiy", "fiz")
_STIFFNESS = (
    *(f"Stiffness {way} [MN/m]" for way in "XYZ"),
    *(f"Stiffness {way} [MNm/rad]" for way in ("Fix", "Fiy", "Fiz")),
)
_ALONG = ("Origin", "Coordinate definition", "Position x [m]", "Repeat (n)", "Delta x [m]")

COLUMNS: dict[str, tuple[str, ...]] = {
    "StructuralMaterial": (
        *("Name", "Type", "Subtype", "Quality", "Unit mass [kg/m3]", "E modulus [MPa]", "G modulus [MPa]"),
        *("Poisson Coefficient", "Thermal expansion [1/K]", "Design properties"),
    ),
    "StructuralCrossSection": (
        *("Name", "Material", "Cross-section type", "Shape", "Parameters [mm]", "Profile", "Form code"),
        *("Description ID of the profile", "A [m2]", "Iy [m4]", "Iz [m4]", "It [m4]"),
    ),
    "StructuralPointConnection": ("Name", "Coordinate X [m]", "Coordinate Y [m]", "Coordinate Z [m]"),
    "StructuralCurveMember": (
        *("Name", "Type", "Cross section", "Nodes", "Segments", "Length [m]", "Geometrical shape", "LCS"),
        *("LCS Rotation [deg]", "Coordinate X [m]", "Coordinate Y [m]", "Coordinate Z [m]", "System line"),
        *("Analysis Y Eccentricity of Beg Node [mm]", "Analysis Z Eccentricity of Beg Node [mm]"),
        *("Analysis Y Eccentricity of End Node [mm]", "Analysis Z Eccentricity of End Node [mm]"),
        *("Layer", "Behaviour in analysis"),
    ),
    "StructuralPointSupport": ("Name", "Type", "Boundary condition", "Node", *_WAYS, *_STIFFNESS),
    "RelConnectsStructuralMember": ("Name", "Member", "Position", *_WAYS, *_STIFFNESS),
    "RelConnectsRigidCross": (
        *("Name", "1D Members", "Type", "u1", "u2", "u", "fi1", "fi2", "fi"),
        "Stiffness fi [MNm/rad]",
    ),
    "RelConnectsRigidLink": ("Name", "Nodes", "Hinge position", *_WAYS),
    "StructuralLoadGroup": ("Name", "Load group type", "Relation", "Load type"),
    "StructuralLoadCase": ("Name", "Description", "Action type", "Load group", "Load type", "Duration"),
    "StructuralLoadCombination": ("Name", "Description", "Category", "National standard", "Type"),
    "StructuralPointAction": (
        *("Name", "Type", "Direction", "Force action", "Reference node", "Reference member", "Value [kN]"),
        *("Vector (X;Y;Z) [kN]", "Load case", "Coordinate system", *_ALONG),
    ),
    "StructuralPointMoment": (
        *("Name", "Type", "Direction", "Force action", "Reference node", "Reference member", "Value [kNm]"),
        *("Load case", "Coordinate system", *_ALONG),
    ),
    "StructuralCurveAction": (
        *("Name", "Type", "Force action", "Distribution", "Direction", "Value 1 [kN/m]", "Member", "Load case"),
        *("Coordinate system", "Location", "Coordinate definition", "Origin", "Extent", "Start point [m]"),
        *("End point [m]", "Eccentricity ey [mm]", "Eccentricity ez [mm]"),
    ),
    "StructuralCurveActionThermal": (
        *("Name", "Force action", "Variation", "deltaT [°C]", "TempL [°C]", "TempR [°C]", "TempT [°C]", "TempB [°C]"),
        *("Member", "Load case", "Coordinate definition", "Origin", "Start point [m]", "End point [m]"),
    ),
    "StructuralPointSupportDef": (
        *("Name", "Point support", "Direction", "Translation value [mm]", "Rotation value [mrad]", "Load case"),
    ),
}
"""Header by sheet, in the order in which a program needs them."""

COMBINED = ("Load factor", "Multiplier", "Load case name")
"""Columns of a combination that come once for each of its cases, with a number."""
