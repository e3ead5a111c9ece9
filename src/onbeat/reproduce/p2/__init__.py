"""P2: the same dance to faster music, on a robot's upper body, 2007."""
