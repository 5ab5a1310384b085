"""Figures that run, and pictures that answer controls."""
