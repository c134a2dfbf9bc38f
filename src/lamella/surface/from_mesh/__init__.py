"""Meshes from files: read, cleaned, their borders as curves, and the surface of constant mean curvature they mean.

`read_mesh` -> `RawMesh` -> `clean` -> `CleanMesh` -> `border_curves` and `fit_mean_curvature` (is it constant, and of
what value) -> `adopt.surface_of_table`, which finds the film nearest to the vertices (`nearest`). A mesh never is the
surface: facets have no curvature.
"""
