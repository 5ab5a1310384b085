"""The answers of a class, judged again, each in a process of its own: points and gradebooks."""
