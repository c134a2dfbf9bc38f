"""Panels on a net: planar quads through its own nodes, their flat outlines, lists and drawing."""
