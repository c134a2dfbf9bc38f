"""The model as a workbook of the Structural Analysis Format (SAF 2.2.0)."""
