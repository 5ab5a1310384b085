"""The exit questions of chapter 0."""

from ikteach.course.quizzes import Quiz

QUIZZES = {
    "00.reachable": Quiz(
        "A hand stays 1 mm from its target, after 100 steps. Is the target out of reach?",
        right="one cannot tell",
        why={
            "yes": "A method may be slow, or stuck: that says nothing about the body.",
            "no": "You cannot know that either: 1 mm may be all that limits allow.",
            "one cannot tell": (
                "Reach is a question about target, body and limits; no step answers it."
            ),
        },
    ),
    "00.spine": Quiz(
        "The spine bends. Which effectors move?",
        right="both hands",
        why={
            "all four": "The legs hang from the pelvis, and the spine is not between.",
            "both hands": "Both arms hang from the spine: see the table.",
            "none, if the arms are held still": "The arms are carried along, held still or not.",
        },
    ),
}
