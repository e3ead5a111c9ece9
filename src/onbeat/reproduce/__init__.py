"""The papers' experiments again: every table and figure of theirs beside ours, from one command."""
