"""One constraint a file; each docstring has the formula and a table variable / symbol / count."""
