"""A ball that is turned like a globe, and says how far."""

import anywidget
import traitlets

from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.page import script, style


class RotationBall(Living, anywidget.AnyWidget):
    """A rotation ball, turned by dragging or the arrow keys.

    The figure that it stands for turns with it.

    azimuth    degrees to the left of the front, −180 to 180
    elevation  degrees above the floor, −85 to 85
    """

    _esm, _css = script("view/widgets/ball.js"), style("view/widgets/ball.css")
    azimuth = traitlets.Float(0.0).tag(sync=True)
    elevation = traitlets.Float(0.0).tag(sync=True)
    label = traitlets.Unicode("Rotation ball").tag(sync=True)
