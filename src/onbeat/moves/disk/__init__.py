"""A library on disk: its index, shards and graph files, and the lock of its builder."""
