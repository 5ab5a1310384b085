"""The exit questions of chapter 3."""

from ikteach.course.quizzes import Quiz

QUIZZES = {
    "03.stuck": Quiz(
        "A straight arm, its target straight inward. What does the transpose do?",
        right="It stands still",
        why="Jᵀe is exactly zero: to first order no joint brings the hand inward.",
        options=["It bends the arm slowly", "It stands still", "It divides by zero"],
    ),
}
