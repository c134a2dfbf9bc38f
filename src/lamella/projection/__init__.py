"""Guided projection: meshes that satisfy constraints at most quadratic in their unknowns (paper section 2.2)."""
