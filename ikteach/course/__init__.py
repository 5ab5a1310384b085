"""What turns the notebooks into a course: opening it, predictions, checks of the exercises.

predict, reveal   a prediction before the code runs, and what came of it
check             whether an exercise is solved, in a sentence
quiz              an exit question
export            all of it in one file, for an assignment
show_in_class     whether answers are counted on the page before the class
source, plainly   the code that a chapter is about, and the same in the fewest lines
show_me           what to try with a live figure, with buttons that do it
"""

from ikteach.course.checking import check
from ikteach.course.questions import predict, quiz, reveal
from ikteach.course.record import export, show_in_class
from ikteach.course.source import plainly, source
from ikteach.course.tries import show_me

__all__ = [
    "check",
    "export",
    "plainly",
    "predict",
    "quiz",
    "reveal",
    "show_in_class",
    "show_me",
    "source",
]
