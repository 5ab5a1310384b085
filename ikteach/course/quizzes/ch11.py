"""The exit questions of chapter 11."""

from ikteach.course.quizzes import Quiz

QUIZZES = {
    "11.proof": Quiz(
        "A figure meets every target to 1 mm. What does that prove of its motion?",
        right="that these points are where they should be",
        why={
            "that it moves as the recorded person does": (
                "Four targets were met to 2 mm while the knees were 30° off."
            ),
            "that these points are where they should be": (
                "All else, such as knees, ground and time, wants a measure of its own."
            ),
            "that it is natural": "The norm's own angles scored best, and slipped.",
        },
    ),
}
