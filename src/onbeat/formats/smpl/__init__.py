"""Motion of the SMPL family, without the model."""
