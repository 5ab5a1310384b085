"""The exit questions of chapter 8."""

from ikteach.course.quizzes import Quiz

QUIZZES = {
    "08.caps": Quiz(
        (
            "The pseudoinverse runs with 5° a step, DLS with 45°. The first has "
            "less jitter. This shows …"
        ),
        right="what its cap does",
        why=(
            "Two things differ at once. With equal caps the order of the two may "
            "turn: look at the table."
        ),
        options=["that it is the calmer method", "what its cap does", "nothing at all"],
    ),
}
