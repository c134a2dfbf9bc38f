"""Problems of the paper, each a function from a mesh to a mesh."""
