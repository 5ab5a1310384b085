"""How long from the click on a chapter to a moving figure, in a site that has been built.

    python tests/bench/site.py SITE [07_gait.ipynb]

Each time in a browser that has never seen the site, from a web server on this machine. A site
whose Pyodide lacks numpy gets as far as its kernel.
"""

import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve()
sys.path[:0] = [str(HERE.parents[2])]

from playwright.sync_api import TimeoutError as TooLong  # noqa: E402
from playwright.sync_api import sync_playwright  # noqa: E402

from tests.browser.conftest import open_browser  # noqa: E402
from tests.browser.test_site import Lite  # noqa: E402

PATIENCE = 240_000  # [ms]
READY = "window.jupyterapp.shell.currentWidget.sessionContext.session.kernel.info.then(() => true)"

WHERE = """() => {
  const picture = document.querySelector(".jp-OutputArea canvas");
  picture?.scrollIntoView({ block: "center" });
  const { x, y, width, height } = picture?.getBoundingClientRect() ?? {};
  return width && y >= 0 ? { x, y, width, height: Math.min(height, innerHeight - y) } : null;
}"""


def main(folder: str, name: str = "07_gait.ipynb") -> None:
    with sync_playwright() as play:
        browser = open_browser(play)
        clicked = time.monotonic()

        def tell(what: str) -> None:
            print(f"{what:28} {time.monotonic() - clicked:6.1f} s", flush=True)

        lite = Lite(browser, Path(folder), name)
        try:
            tell("notebook shown")
            lite.page.evaluate(READY)
            lite.run("pass")
            tell("kernel has answered")
            lite.page.evaluate("void window.jupyterapp.commands.execute('notebook:run-all-cells')")
            picture = lite.page.locator(".jp-OutputArea canvas").first
            picture.wait_for(state="attached", timeout=PATIENCE)
            tell("first figure there")
            seen: set[bytes] = set()
            while len(seen) < 2:  # JupyterLab takes what is out of sight out of the page
                if box := lite.page.evaluate(WHERE):
                    seen.add(lite.page.screenshot(clip=box))
                if time.monotonic() - clicked > PATIENCE / 1000:
                    raise TooLong("the figure stands still")
            tell("it has moved")
        except TooLong:
            print("no moving figure: its Pyodide has no numpy, or the machine is too slow")
        finally:
            print(f"asked of other places: {lite.outside or 'nothing'}")
            lite.close()
            browser.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
