"""The instructor's pack: slides, plans, a map, a key, projects and a question bank.

Everything is made of what the course has already: its notebooks, its exit questions, TEACHING.md,
its own functions. Only what stands in none of them is in `texts`. It holds answers, so that it is
for who teaches; `projects/` alone is for students.
"""
