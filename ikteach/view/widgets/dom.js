// Elements of a page, and their events.

/** Attributes of what takes keys, which the notebook would take for its own. */
export const OWN_KEYS = { "data-lm-suppress-shortcuts": "true" };

/**
 * Make an element of HTML with these attributes and children.
 * @template {keyof HTMLElementTagNameMap} Name
 * @param {Name} name
 * @param {Attributes} [attributes]
 * @param {(Node | string)[]} children
 */
export function element(name, attributes = {}, ...children) {
  return filled(document.createElement(name), attributes, children);
}

/**
 * Make an element of SVG with these attributes and children.
 * @template {keyof SVGElementTagNameMap} Name
 * @param {Name} name
 * @param {Attributes} [attributes]
 * @param {(Node | string)[]} children
 */
export function svg(name, attributes = {}, ...children) {
  return filled(document.createElementNS("http://www.w3.org/2000/svg", name), attributes, children);
}

/**
 * @template {Element} Made
 * @param {Made} made
 * @param {Attributes} attributes
 * @param {(Node | string)[]} children
 */
function filled(made, attributes, children) {
  set(made, attributes);
  made.append(...children);
  return made;
}

/**
 * Set attributes of an element.
 * @param {Element} one
 * @param {Attributes} attributes
 */
export function set(one, attributes) {
  for (const [name, value] of Object.entries(attributes)) one.setAttribute(name, `${value}`);
}

/**
 * Keep an event from the browser and from the notebook.
 * @param {Event} event
 */
export function take(event) {
  event.preventDefault();
  event.stopPropagation();
}

/**
 * Call each act on its event of a model (one name: marimo's models know no lists of names); call the
 * answer to stop that.
 * @param {Source} source
 * @param {Record<string, Act>} acts
 */
export function listen(source, acts) {
  for (const [event, act] of Object.entries(acts)) source.on(event, act);
  return () => {
    for (const [event, act] of Object.entries(acts)) source.off(event, act);
  };
}

/**
 * Call each act on its events of a target.
 * @param {EventTarget} target
 * @param {Record<string, (event: any) => void>} acts
 * @param {AddEventListenerOptions} options
 */
export function listenTo(target, acts, options) {
  for (const [name, act] of Object.entries(acts)) target.addEventListener(name, act, options);
}

/**
 * The element, once it is in the page; undefined if it leaves before it came.
 * @param {Element} el
 * @param {() => boolean} gone
 */
export async function connected(el, gone = () => false) {
  while (!gone()) {
    if (el.isConnected) return el;
    await new Promise(requestAnimationFrame);
  }
}
