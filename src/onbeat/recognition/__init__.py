"""Recognition: who dances what. Segments of dances, the multi-factor tensor of tasks and people, and what is new."""
