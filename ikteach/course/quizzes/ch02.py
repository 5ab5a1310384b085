"""The exit questions of chapter 2."""

from ikteach.course.quizzes import Quiz

QUIZZES = {
    "02.free": Quiz(
        "An arm is exactly straight, and its target lies straight inward. What sets it free?",
        right="a little bend, by whatever means",
        why={
            "more damping": "Damping shortens steps. Here every step is 0 already.",
            "more iterations": "Each of them is 0: the pose does not change.",
            "a little bend, by whatever means": "Then Jᵀe is no longer 0, and the step can grow.",
        },
    ),
    "02.det": Quiz(
        "A program warns when det J < 0.001. Then all lengths are given in millimetres. What now?",
        right="it hardly ever warns",
        why={
            "it warns as before": "A determinant grows with a power of the unit of length.",
            "it hardly ever warns": "det J of three joints grows a thousand million times.",
            "it warns too often": "Millimetres make the numbers larger, not smaller.",
        },
    ),
}
