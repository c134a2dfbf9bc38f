"""Lists of tables that a project may have."""

from __future__ import annotations

from lamella.project.load_tables import ACTION_TABLES
from lamella.project.stock_table import StockTable
from lamella.project.values import Table

LIST_TABLES: dict[str, type[Table]] = {"stock": StockTable, **ACTION_TABLES}
"""In the order of the documentation."""
