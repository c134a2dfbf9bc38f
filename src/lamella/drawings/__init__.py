"""Drawings for people: a set of sheets as PDF, and the cutting drawings as SVG."""
