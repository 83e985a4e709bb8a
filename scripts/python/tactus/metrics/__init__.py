"""Metrics of a degraded rendering: how late, how coarse and how old it is, beside the undegraded one."""
