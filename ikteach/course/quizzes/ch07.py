"""The exit questions of chapter 7."""

from ikteach.course.quizzes import Quiz

QUIZZES = {
    "07.hands": Quiz(
        "The hands never arrive. What does that say about the four methods?",
        right="nothing by itself",
        why={
            "they are all bad": "No method can put a hand where no pose puts it.",
            "nothing by itself": (
                "Look at what they do meanwhile: jitter, and what the feet suffer."
            ),
            "the nearest one is the best": (
                "The table has one whose feet are as near as any, and it shakes."
            ),
        },
    ),
}
