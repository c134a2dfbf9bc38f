"""The structural model in the formats of other programs."""
