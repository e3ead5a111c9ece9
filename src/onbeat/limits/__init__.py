"""What the joints of a body can do: tables of robots, files, limits learned from motions."""
