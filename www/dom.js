/** Small helpers to build elements. Text always goes in as text, never as markup. */

const SVG = 'http://www.w3.org/2000/svg';

/**
 * An HTML element. `props`: `on` is a map of listeners, `style` a map of CSS properties (set through CSSOM, since
 * the page's policy forbids inline styles), `value`/`checked`/`disabled` … are properties, all else attributes.
 * @param {string} tag
 * @param {Record<string, any>} [props]
 * @param {...(Node|string|null|undefined|false)} children
 */
export function h(tag, props = {}, ...children) {
  return fill(document.createElement(tag), props, children);
}

/** The same for SVG. */
export function svg(tag, props = {}, ...children) {
  return fill(document.createElementNS(SVG, tag), props, children);
}

/**
 * Replaces what is in `parent`. A control that had the focus and comes again (by its id) has it again; if it does not,
 * the nearest one before it has, or after it.
 */
export function show(parent, ...children) {
  const heirs = heirsOf(parent);
  parent.replaceChildren(...children.flat().filter((child) => child != null && child !== false));
  heirs.map((id) => document.getElementById(id)).find(Boolean)?.focus();
  return parent;
}

/** The ids of the controls that are to have the focus if it is in `parent`, the one that has it first. */
function heirsOf(parent) {
  const focused = document.activeElement;
  if (!parent.contains(focused)) return [];
  const named = [...parent.querySelectorAll(':is(button, input, select, a)[id]')];
  const place = named.indexOf(focused);
  return [...named.slice(0, place + 1).reverse(), ...named.slice(place + 1)].map(({ id }) => id);
}

const PROPERTIES = new Set(['value', 'checked', 'disabled', 'hidden', 'open', 'selected', 'htmlFor', 'indeterminate']);

function fill(element, props, children) {
  for (const [name, value] of Object.entries(props)) {
    if (value == null || value === false) continue;
    if (name === 'on') for (const [event, listener] of Object.entries(value)) element.addEventListener(event, listener);
    else if (name === 'style') for (const [key, entry] of Object.entries(value)) element.style.setProperty(key, entry);
    else if (PROPERTIES.has(name)) element[name] = value;
    else element.setAttribute(name, value === true ? '' : value);
  }
  element.append(...children.flat().filter((child) => child != null && child !== false));
  return element;
}

const ICONS = {
  play: 'M7 4.5v15l12-7.5z',
  pause: 'M7 5h3.5v14H7zM13.5 5H17v14h-3.5z',
  close: 'M6 6l12 12M18 6L6 18',
  panel: 'M4 5h16v14H4zM14.5 5v14',
  sun: 'M12 8a4 4 0 100 8 4 4 0 000-8zM12 2.5v2M12 19.5v2M2.5 12h2M19.5 12h2M5.3 5.3l1.4 1.4M17.3 17.3l1.4 1.4M5.3 18.7l1.4-1.4M17.3 6.7l1.4-1.4',
  link: 'M10 14a4 4 0 005.7 0l3-3a4 4 0 00-5.7-5.7l-1 1M14 10a4 4 0 00-5.7 0l-3 3A4 4 0 0011 18.700l1-1',
  picture: 'M4 7.5h3.5l1.5-2.5h6l1.5 2.5H20V19H4zM12 10a3.2 3.2 0 100 6.4 3.2 3.2 0 000-6.400z',
  keys: 'M9.3 9a2.8 2.8 0 115.4.900c0 1.9-2.7 2.2-2.7 4.100M12 17.400v.2',
  frame: 'M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5',
  previous: 'M14 6l-6 6 6 6',
  next: 'M10 6l6 6-6 6',
  save: 'M12 4v11M7.5 11l4.5 4.5L16.5 11M5 19.5h14',
  check: 'M5 12.500l4.500 4.500L19 7.500',
  undo: 'M8.500 5L4 9.500 8.500 14M4 9.500h10.500a5 5 0 010 10H10',
  redo: 'M15.500 5L20 9.500 15.500 14M20 9.500H9.500a5 5 0 000 10H14',
  cameras: 'M3.500 8.500h6v7h-6zM14.500 8.500h6v7h-6zM9.500 12h5',
  tours: 'M4 6.500c3-1.500 6-1 8 .500 2-1.500 5-2 8-.500v12c-3-1.500-6-1-8 .500-2-1.500-5-2-8-.500zM12 7v12',
  reset: 'M5 12a7 7 0 107-7H7M9.5 2L6.5 5l3 3',
};

/** A 24-unit line icon (filled for play and pause). */
export function icon(name) {
  const solid = name === 'play' || name === 'pause';
  return svg('svg', { viewBox: '0 0 24 24', class: solid ? 'icon solid' : 'icon', 'aria-hidden': 'true' },
    svg('path', { d: ICONS[name] }));
}

/** A button with an icon and a label that only assistive technology and the tooltip show. */
export function iconButton(name, label, onClick, props = {}) {
  return h('button', { type: 'button', class: 'icon-button', 'aria-label': label, title: label, on: { click: onClick }, ...props },
    icon(name));
}
