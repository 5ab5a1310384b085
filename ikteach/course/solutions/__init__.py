"""The solutions of the exercises, a module a chapter; they are not in the wheel.

Each begins with a line `# %% key` and goes on to the next one: this is the cell that
`python -m ikteach build instructor` folds in after the exercise. Its last statement binds the
answer. What stands above the first is for the linter; a cell must do with the notebook's names and
imports of its own.
"""
