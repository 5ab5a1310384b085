"""Panels over a session: record, replay, save, inspect."""
