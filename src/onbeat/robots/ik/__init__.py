"""Inverse kinematics of a whole dance: directions wanted, collisions kept away from, solved over all frames."""
