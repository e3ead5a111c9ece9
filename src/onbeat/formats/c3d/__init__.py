"""C3D: labelled points of optical motion capture."""
