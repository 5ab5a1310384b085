"""The exit questions of chapter 5."""

from ikteach.course.quizzes import Quiz

QUIZZES = {
    "05.singular": Quiz(
        "At an exactly singular pose the target lies in the lost direction only. DLS takes …",
        right="no step",
        why="That direction's answer is σ/(σ² + λ²) with σ = 0: nothing, for every λ.",
        options=["a long step", "a short step", "no step"],
    ),
}
