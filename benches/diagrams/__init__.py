"""Diagrams of run time against error."""
