"""Wrong answers to the exercises, a module a chapter: `chNN.WRONG`.

    WRONG = {
        "01.column": [
            (lambda v, p, s: np.cross(s - p, v), "other way round"),
            ...
        ],
    }

Each is a typical wrong answer, and a piece of the sentence that must be said about it. Every
exercise needs three or more. The right ones are in `ikteach/course/solutions/chNN.py`. Both are
found by `tests/course/test_exercises.py`; nothing else is to be written for a new exercise.
"""
