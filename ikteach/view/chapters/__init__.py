"""The live figure of each chapter, in a module of the chapter's name."""
