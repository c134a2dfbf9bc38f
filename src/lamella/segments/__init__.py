"""Segments: what of a structure is assembled, carried and lifted in one."""
