"""Meshes from files: read, cleaned, their borders as curves, and the mean curvature they mean.

`read_mesh` -> `RawMesh` -> `clean` -> `CleanMesh` -> `border_curves` and `fit_mean_curvature`. The surface of constant
mean curvature nearest to such a mesh is found elsewhere; a mesh never is the surface (facets have no curvature).
"""
