"""Where the tasks of a build are done: threads, processes, a cluster."""
