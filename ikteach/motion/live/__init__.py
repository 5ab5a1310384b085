"""A session that is played: targets, poses and what happened, tick by tick."""
