"""The exit questions of chapter 10."""

from ikteach.course.quizzes import Quiz

QUIZZES = {
    "10.cure": Quiz(
        "What ends the oscillation while the back turns?",
        right="choosing packages by the cursor alone",
        why="Two packages that each undo the other's work do so with small steps, too.",
        options=["choosing packages by the cursor alone", "a smaller step", "a larger λ"],
    ),
}
