"""The library of moves: clips, their features, and the graph of poses at which one may join another."""
