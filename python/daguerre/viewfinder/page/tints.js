// tints.js -- the picture by exposure or by distance: its buttons and its legend.

import {press} from './dom.js';
import {feet, metres} from './scales.js';

const TINTS = {'false-colour': 'false colour', depth: 'depth of field'};

export class Tints {
  constructor(view) {
    this.view = view;
    this.legend = view.find('legend');
    this.buttons = [...view.root.querySelectorAll('[data-tint]')];
    for (const button of this.buttons) {
      button.addEventListener('click', () => {
        const {tint} = button.dataset;
        view.send({show: {tint: view.state.show.tint === tint ? 'none' : tint}});
      });
    }
  }

  update({show}) {
    for (const button of this.buttons) press(button, show.tint === button.dataset.tint);
    this.explain();
  }

  shown(head) {
    this.head = head;
    this.explain();
  }

  /** Draws the legend of the tint that is shown. */
  explain() {
    const {tint, panels} = this.head ?? {}, {open, state: {readings}} = this.view;
    this.legend.hidden = !tint || !readings.lens;
    if (this.legend.hidden) return;
    const {note, kind} = tint;
    const colours = open.legends[kind];
    const rows = note ? [] : kind !== 'depth' ? zones(colours) : panels.length ? sides(colours) : parts(colours, readings);
    const title = note || (kind === 'depth' ? '' : 'EV from 18 % grey');
    this.legend.setAttribute('aria-label', `Legend of ${TINTS[kind]}: ${title || rows.map(([, text]) => text).join('; ')}`);
    this.legend.replaceChildren(made('b', title), ...rows.map(([colour, text]) => {
      const swatch = made('span', text);
      swatch.style.background = `rgb(${colour})`;
      swatch.style.color = luma(colour) > 110 ? '#000' : '#fff';
      return swatch;
    }));
  }
}

function zones(colours) {
  const ends = {0: '≤', [colours.length - 1]: '≥'};
  return colours.map(([ev, colour], i) => [colour, `${ends[i] ?? ''}${ev > 0 ? '+' : ''}${ev}`.replace('-', '−')]);
}

/** Pictures side by side have limits of their own. */
function sides([near, sharp, far]) {
  return [[near, 'nearer'], [sharp, 'sharp'], [far, 'farther']];
}

function parts([near, sharp, far], {near_m: from, far_m: to, f_stop: stop}) {
  const both = (value) => `${metres(value)} (${feet(value)})`;
  if (stop === null) return [[sharp, 'everything is sharp']];
  const rows = [[near, `nearer than ${both(from)}`], [sharp, `sharp to ${both(to)}`]];
  return to === null ? rows : [...rows, [far, 'farther']];
}

const luma = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

function made(name, text) {
  const element = document.createElement(name);
  element.textContent = text;
  return element;
}
