"""Surfaces on which lamellas of one normal curvature cross at one angle, other than 90 degrees, between boundaries."""
