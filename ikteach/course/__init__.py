"""What turns the notebooks into a course: opening it, predictions, checks of the exercises.

predict, reveal   a prediction before the code runs, and what came of it
check             whether an exercise is solved, in a sentence
quiz              an exit question
export            all of it in one file, for an assignment
source            the code that a chapter is about
"""

from ikteach.course.checking import check
from ikteach.course.questions import predict, quiz, reveal
from ikteach.course.record import export
from ikteach.course.source import source

__all__ = ["check", "export", "predict", "quiz", "reveal", "source"]
