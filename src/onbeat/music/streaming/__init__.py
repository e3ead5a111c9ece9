"""Beats as sound streams by: the parts of the causal tracker."""
