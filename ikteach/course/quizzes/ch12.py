"""The exit questions of chapter 12."""

from ikteach.course.quizzes import Quiz

QUIZZES = {
    "12.length": Quiz(
        "A direction is twice as long. What does a method make of it?",
        right="its rows of J and e are twice as large: it counts more",
        why={
            "nothing: a direction has no length": "Its error is a difference of arrows, in metres.",
            "its rows of J and e are twice as large: it counts more": (
                "As with the weight 2: fewer ticks, and others give way sooner."
            ),
            "the limb that carries it is longer": "No bone has changed, only how much it counts.",
        },
    ),
}
