"""The checkers of the exercises, a module a chapter (see `ikteach.course.checking`)."""
