"""A robot in MuJoCo: motors, sensors, feedback, and what goes wrong on a stage."""
