"""Cutting stock: pieces in lanes (bars, rows of sheets), rectangles on sheets."""
