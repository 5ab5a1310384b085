"""The exit questions of chapter 1."""

from ikteach.course.quizzes import Quiz

QUIZZES = {
    "01.zero-arrow": Quiz(
        (
            "The arrow of a joint at the hand is 0 in this pose, though the joint "
            "carries the hand. Why?"
        ),
        right="the axis passes through the hand",
        why={
            "the axis passes through the hand": "v × (s − p) is 0 when s − p lies along v.",
            "the joint is at its limit": "J knows no limits.",
            "the tree has a zero there": "Then the joint would not carry the hand.",
        },
    ),
    "01.differences": Quiz(
        "Finite differences with h = 1e-12 rad are worse than with h = 1e-6. Why?",
        right="rounding is divided by 2h",
        why={
            "the model is less linear there": (
                "It is more so: the error of the formula goes with h²."
            ),
            "the joint meets its limit": "Neither forward nor jacobian knows limits.",
            "rounding is divided by 2h": "The two places differ in their last digits only.",
        },
    ),
}
