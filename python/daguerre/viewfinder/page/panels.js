// panels.js -- panels beside the picture, such as Rays; at most a single panel is open.
//
// A panel is `<section class="panel" id="NAME" aria-label="..." hidden>` in `#panels`. A button with
// `data-panel="NAME"` opens and closes it, as does `open`. Escape and its own button close it. The panel
// gets the events `open` and `close`.

import {recall, remember} from './memory.js';

export class Panels {
  constructor(root) {
    this.root = root;
    this.shown = null;   // name of the open panel
    for (const panel of root.querySelectorAll('.panel')) {
      const close = document.createElement('button');
      close.type = 'button';
      close.className = 'close';
      close.textContent = '×';
      close.title = 'Close (Escape)';
      close.setAttribute('aria-label', `Close ${panel.getAttribute('aria-label')}`);
      close.addEventListener('click', () => this.open(null));
      panel.append(close);
    }
    for (const button of root.querySelectorAll('[data-panel]')) {
      const name = button.dataset.panel;
      button.setAttribute('aria-controls', name);
      button.addEventListener('click', () => this.open(this.shown === name ? null : name));
    }
    this.open(recall('panel', null));
  }

  /** Opens a panel in place of the open panel; null: closes it. */
  open(name) {
    const [before, now] = [this.shown, name].map((one) => this.root.getElementById(one ?? ''));
    if (name && !now?.classList.contains('panel')) return;   // remembered by another version
    const focused = before?.contains(this.root.activeElement);
    this.shown = name;
    remember('panel', name);
    for (const button of this.root.querySelectorAll('[data-panel]')) {
      button.setAttribute('aria-expanded', button.dataset.panel === name);
      if (focused && button.dataset.panel === before.id) button.focus();
    }
    if (before) before.hidden = true;
    if (now) now.hidden = false;
    before?.dispatchEvent(new Event('close'));
    now?.dispatchEvent(new Event('open'));
  }
}
