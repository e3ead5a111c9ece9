"""Acclaim ASF and AMC, as CMU's files have them."""
