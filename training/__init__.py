"""Making the weights of the learned activation: patterns, sounds, rooms, training. Not needed to use onbeat."""
