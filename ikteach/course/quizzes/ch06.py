"""The exit questions of chapter 6."""

from ikteach.course.quizzes import Quiz

QUIZZES = {
    "06.small": Quiz(
        "The error becomes smaller and smaller at one and the same pose. What does SDLS become?",
        right="the pseudoinverse",
        why=(
            "Each turn asked for falls below its bound γ, which does not depend "
            "on e; then nothing is cut."
        ),
        options=["DLS with λ = γ max", "the pseudoinverse", "the transpose"],
    ),
}
