"""A robot's legs: tasks of a dancer's legs, footfalls that a robot can do, feet planted or stepping."""
