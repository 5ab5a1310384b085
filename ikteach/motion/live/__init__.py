"""A session that is played: targets, poses and events, tick by tick."""
