"""Close pairs of frames: blocks of the table of distances, exact or coarse to fine."""
