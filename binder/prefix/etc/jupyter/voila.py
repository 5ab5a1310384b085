"""Voilà's pages on this server look as those of `python -m ikteach lecture` do."""

from ikteach.course.lecture.server import SETTINGS

c.VoilaConfiguration.update(SETTINGS["VoilaConfiguration"], template="ikteach")  # noqa: F821
