"""Voilà's pages on this server look as those of `python -m ikteach lecture` do."""

from ikteach.serve.lecture.server import SETTINGS


def own_mathjax(page, **_):
    """Within another server, Voilà would fetch MathJax from a content network; None: its own."""
    return page | {"fullMathjaxUrl": None, "mathjaxConfig": None}


c.VoilaConfiguration.update(
    SETTINGS["VoilaConfiguration"], template="ikteach", page_config_hook=own_mathjax
)
