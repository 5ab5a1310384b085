"""The exit questions of chapter 4."""

from ikteach.course.quizzes import Quiz

QUIZZES = {
    "04.null": Quiz(
        (
            "P = I − J⁺J. You add PΔ to the step, for some Δ. To first order, "
            "where do the effectors go?"
        ),
        right="Where they went without it",
        why="JP = 0: what is added turns joints and moves no effector.",
        options=["Where they went without it", "Nearer to the targets", "Away from the targets"],
    ),
}
