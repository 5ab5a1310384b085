"""How long from the click on chapter 7 to a moving figure, in a site that has been built.

    python tests/bench/site.py SITE

Each time in a browser that has never seen the site, from a web server on this machine; the figure's
cell is run as soon as it can be. A site whose Pyodide lacks numpy gets as far as its kernel.
"""

import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve()
sys.path[:0] = [str(HERE.parents[2])]

from playwright.sync_api import TimeoutError as TooLong  # noqa: E402
from playwright.sync_api import sync_playwright  # noqa: E402

from tests.browser.conftest import CANVAS, SHOWN, open_browser  # noqa: E402
from tests.browser.test_site import Lite  # noqa: E402

PATIENCE = 240_000  # [ms]
READY = "window.jupyterapp.shell.currentWidget.sessionContext.session.kernel.info.then(() => true)"
FRAMES = f"document.querySelector('.ikteach-driver')?.dataset.shown ? {SHOWN} : 0"


def main(folder: str) -> None:
    with sync_playwright() as play:
        browser = open_browser(play)
        clicked = time.monotonic()

        def tell(what: str) -> None:
            print(f"{what:28} {time.monotonic() - clicked:6.1f} s", flush=True)

        lite = Lite(browser, Path(folder), "07_gait.ipynb")
        page = lite.page
        try:
            tell("notebook shown")
            page.evaluate(READY)
            lite.run("pass")
            tell("kernel has answered")
            cell = page.locator(".jp-CodeCell", has_text="player = GaitPlayer()").first
            cell.locator(".cm-content").click()
            page.evaluate("void window.jupyterapp.commands.execute('notebook:run-cell')")
            page.wait_for_function(f"({FRAMES}) >= 2", timeout=PATIENCE)
            tell("figure moves")
            picture = page.locator(CANVAS).first
            picture.scroll_into_view_if_needed()
            before, first, began = picture.screenshot(), page.evaluate(SHOWN), time.monotonic()
            page.wait_for_timeout(5000)
            shown, lasted = page.evaluate(SHOWN) - first, time.monotonic() - began
            print(f"{shown / lasted:.0f} poses drawn a second")
            if picture.screenshot() == before:
                print("but the picture is as before")
        except TooLong:
            print("no moving figure: its Pyodide has no numpy, or the machine is too slow")
        finally:
            print(f"asked of other places: {lite.outside or 'nothing'}")
            lite.close()
            browser.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
