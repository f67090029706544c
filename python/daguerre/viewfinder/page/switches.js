// switches.js -- switches of the light that a lens adds: ghosts, stars, scatter.

import {press, pressed, title} from './dom.js';

/** Texts of a dial that is on and off, and dials that belong to it. */
const SWITCHES = {
  flare: {on: 'auto', off: 'off', others: ['flare_order', 'flare_highlights']},
  diffraction: {on: '1', off: '0', others: ['diffraction_bands', 'diffraction_zones']},
  scatter: {on: 'auto', off: 'off', others: ['flare_highlights']},
};

export class Switches {
  constructor(view) {
    this.view = view;
    this.buttons = [...view.root.querySelectorAll('[data-switch]')].map((button) => ({button, means: button.title}));
    for (const {button} of this.buttons) {
      button.addEventListener('click', () => this.turn(button.dataset.switch, !pressed(button)));
    }
  }

  /** Turns a switch off, or on: with its value at the opening of the page, if it was on. */
  turn(dial, on) {
    const {open: {dials, lit}} = this.view, switched = SWITCHES[dial];
    if (!on) return this.view.turn({[dial]: lit.includes(dial) ? switched.off : null});
    const given = dials[dial] && dials[dial] !== switched.off ? [dial, ...switched.others] : [];
    const opened = Object.fromEntries(given.filter((name) => dials[name]).map((name) => [name, dials[name]]));
    this.view.turn({[dial]: switched.on, ...opened});
  }

  update({lit, readings: {lens, switches}}) {
    const {mine} = this.view;
    for (const {button, means} of this.buttons) {
      const dial = button.dataset.switch, can = !lens || switches.includes(dial);
      press(button, lit.includes(dial));
      button.disabled = !mine || !can;
      title(button, can ? means : `${means}; this lens has none`);
    }
  }
}
