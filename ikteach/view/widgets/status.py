"""A line on what goes on, which screen readers read out when it changes."""

import anywidget
import traitlets

from ikteach.view.widgets.closing import Living
from ikteach.view.widgets.esm import esm

_ESM = """
function render({ model, el }) {
  // Both stay where they are while their words change: only then are changes read out.
  const said = document.createElement("div"), wrong = document.createElement("div");
  said.setAttribute("role", "status");
  said.setAttribute("aria-live", "polite");
  wrong.setAttribute("role", "alert");
  el.append(said, wrong);
  el.classList.add("ikteach-status");
  function update() {
    said.textContent = model.get("said");
    wrong.textContent = model.get("wrong");
    wrong.style.cssText =
      model.get("wrong") ? "border-left:4px solid #d55e00;padding:4px 10px;margin:4px 0" : "";
  }
  model.on("change", update);
  update();
  return () => model.off("change", update);
}
export default { render: told(render) };
"""


class Status(Living, anywidget.AnyWidget):
    """A sentence on what goes on, and one on what went wrong."""

    _esm = esm() + _ESM
    said = traitlets.Unicode("").tag(sync=True)
    wrong = traitlets.Unicode("").tag(sync=True)

    def say(self, words: str) -> None:
        """Say what goes on; what was wrong is over."""
        with self.hold_sync():
            self.said, self.wrong = words, ""

    def fail(self, words: str) -> None:
        """Say what went wrong."""
        with self.hold_sync():
            self.said, self.wrong = "", words
