"""What holds a net and what acts on it, in the order of the network's nodes, before there is a model of it."""
