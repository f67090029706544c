// keys.js -- the table of keys: each presses a control of the page, or goes to it.
//
// Tooltips and the list of keys (?) come from this table. A key that is held holds its control.

import {title} from './dom.js';

const HELD = 'held';
const KEYS = [
  ['1', '#ring-focus_distance'], ['2', '#ring-f_stop'], ['3', '#ring-shutter_time'], ['4', '#ring-iso'],
  ['5', '#ring-exposure_compensation'], ['6', '#ring-white_balance'], ['7', '#ring-blades'], ['8', '#ring-zoom'],
  ['9', '#ring-time'], ['O', '#lens'], ['E', '#exposure'], ['K', '#lock'], ['Y', '#hyperfocal'],
  ['J', '[data-switch=flare]'], ['I', '[data-switch=diffraction]'], ['U', '[data-switch=scatter]'],
  ['G', '[data-toggle=grid]'], ['H', '[data-toggle=horizon]'], ['Z', '[data-toggle=zebra]'],
  ['P', '[data-toggle=peaking]'], ['L', '[data-toggle=loupe]'], ['R', '[data-panel=rays]'],
  ['T', '[data-tint=false-colour]'], ['D', '[data-tint=depth]'], ['B', '[data-toggle=parade]'], ['A', '#guides'],
  ['M', '[data-show=models]'], ['N', '[data-show=denoised]'], ['C', '#compare', HELD], ['X', '#beside'],
  ['V', '#level'], ['0', '#reset'], ['S', '[data-save=png]'],
  ['Ctrl+Y', '#redo'], ['Ctrl+Shift+Z', '#redo'], ['Ctrl+Z', '#undo'], ['F', '#full'], ['?', '#help'],
];
/** Keys of a part of the page that has the focus; ring.js, tripod.js and browsers bind them. */
const ELSEWHERE = {
  'In a ring': [['← →', 'A step'], ['PgUp PgDn', 'Five steps']],
  'On the divider': [['← →', 'A step'], ['PgUp PgDn', 'Ten steps'], ['Home End', 'To an edge']],
  'In the picture': [['← → ↑ ↓', 'Orbit'], ['+ -', 'Dolly'], ['[ ]', 'Roll']],
};
const TYPED = 'input:not([type=range], [type=checkbox], [type=radio]), textarea';

export class Keys {
  constructor({root, find, panels}) {
    this.root = root;
    this.find = find;
    this.panels = panels;
    this.held = null;
    for (const [key, selector] of KEYS) {
      const control = root.querySelector(selector);
      control.setAttribute('aria-keyshortcuts', key);
      title(control, control.title);
    }
    root.addEventListener('keydown', (event) => this.down(event));
    root.addEventListener('keyup', () => this.release());
    find('help').addEventListener('click', () => this.list());
    for (const button of root.querySelectorAll('dialog .close')) {
      button.addEventListener('click', () => button.closest('dialog').close());
    }
  }

  down(event) {
    if (event.altKey || event.defaultPrevented) return;
    const dialog = this.root.querySelector('dialog[open]');
    if (event.key === 'Escape') {
      if (dialog) dialog.close();
      else if (this.panels.shown) this.panels.open(null);
      else return;
    } else if (dialog || isTyped(event) || !this.press(event)) return;
    event.preventDefault();
    event.stopPropagation();   // a notebook has keys of its own
  }

  /** Acts on a key; returns whether the table has the key and its control can be used. */
  press(event) {
    const [, selector, held] = KEYS.find(([key]) => key.toLowerCase() === nameOf(event)) ?? [];
    const control = selector && this.root.querySelector(selector);
    if (!control || control.disabled || !control.checkVisibility()) return false;
    if (event.repeat && (held || control.hasAttribute('aria-pressed'))) return true;
    if (held) this.hold(control);
    else if (control.matches('button')) control.click();
    else control.focus();
    return true;
  }

  hold(control) {
    this.held = control;
    control.dispatchEvent(new PointerEvent('pointerdown'));
  }

  release() {
    this.held?.dispatchEvent(new PointerEvent('pointerup'));
    this.held = null;
  }

  /** Opens the list of keys. */
  list() {
    const own = KEYS.map(([key, selector]) => [key, this.root.querySelector(selector)])
      .filter(([, control]) => control.checkVisibility()).map(([key, control]) => [key, nameOfControl(this.root, control)]);
    const parts = Object.entries({'Anywhere': [...own, ['Escape', 'Close a panel']], ...ELSEWHERE});
    this.find('keys-list').replaceChildren(...parts.flatMap(([where, rows]) => [made('h3', where), listOf(rows)]));
    this.find('keys').showModal();
  }
}

/** Whether a key is text for a field, or finds an option of a select. */
function isTyped(event) {
  const field = event.composedPath()[0];
  return field.matches?.(TYPED) || (field.matches?.('select') && !event.ctrlKey && !event.metaKey);
}

/** Name of a key in the table, in small letters: `g`, `ctrl+shift+z`. */
function nameOf(event) {
  const key = event.key.toLowerCase();
  const shift = event.shiftKey && /^[a-z]$/.test(key);
  return [event.ctrlKey || event.metaKey ? 'ctrl' : '', shift ? 'shift' : '', key].filter(Boolean).join('+');
}

function nameOfControl(root, control) {
  const label = root.getElementById(control.getAttribute('aria-labelledby')?.split(' ')[0] ?? '');
  return control.getAttribute('aria-label') ?? (label ?? control.labels[0]?.firstChild ?? control).textContent.trim();
}

function listOf(rows) {
  const list = document.createElement('dl');
  list.append(...rows.map(([key, says]) => {
    const row = document.createElement('div');
    row.append(made('dt', key), made('dd', says));
    return row;
  }));
  return list;
}

function made(name, text) {
  const element = document.createElement(name);
  element.textContent = text;
  return element;
}
