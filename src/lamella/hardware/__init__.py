"""Parts beside the strips: what joins them at the nodes, and what holds the layers of a lamella together."""
