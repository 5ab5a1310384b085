// Whether the page is dark, which JupyterLab writes into its body.

const LIGHT = "data-jp-theme-light";

/**
 * Tell the kernel, now and whenever it changes; call the answer to stop that.
 * @param {Model} model with a trait `dark`
 */
export function followTheme(model) {
  function tell() {
    const dark = document.body.getAttribute(LIGHT) === "false";
    if (dark === model.get("dark")) return;
    model.set("dark", dark);
    model.save_changes();
  }

  const observer = new MutationObserver(tell);
  observer.observe(document.body, { attributeFilter: [LIGHT] });
  tell();
  return () => observer.disconnect();
}
