"""What a robot is: its description, read from URDF, MJCF or TOML, and written as MJCF."""
