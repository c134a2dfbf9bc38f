"""From lamellas of a net to a structure of beams, cables and springs."""
