"""What turns the notebooks into a course: opening it, predictions, checks of the exercises."""
