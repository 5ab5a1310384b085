"""What is drawn: figures, their skin and marks, before any renderer."""
