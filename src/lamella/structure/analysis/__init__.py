"""What a net does as a structure: let go, under loads, when it buckles and how it swings."""
