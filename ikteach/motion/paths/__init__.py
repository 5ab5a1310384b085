"""Motions beyond the sine: a natural walk, recordings, curves drawn by hand, and their measures."""
