// compare.js -- shows the previous picture at rest, while its button is held.

import {metres, shutterLabel} from './scales.js';

const PAUSE_MS = 1000;   // a picture that stays for less was on the way to another

export class Compare {
  constructor(view) {
    this.view = view;
    this.rest = null;     // the newest picture at rest: its turn, sheet, and settings in words
    this.before = null;   // the previous picture at rest
    this.button = view.find('compare');
    const on = (names, act) => names.forEach((name) => this.button.addEventListener(name, act));
    on(['pointerdown'], (event) => this.hold(event));
    on(['pointerup', 'pointercancel', 'blur', 'keyup'], () => this.show(false));
    on(['keydown'], (event) => [' ', 'Enter'].includes(event.key) && this.show(true));
    on(['contextmenu'], (event) => event.preventDefault());   // a finger that stays would open a menu
  }

  /** A finger may slip off the button while it holds. */
  hold(event) {
    if (event.isTrusted) this.button.setPointerCapture(event.pointerId);
    this.show(true);
  }

  show(on) {
    if (on && this.before) this.view.picture.compare(this.before.sheet);
    else if (this.shows) this.view.picture.compare(null);
    this.say(on && this.before ? `Before: ${this.before.words}` : '');
  }

  say(text) {
    this.shows = text !== '';
    this.view.find('which').textContent = text;
    this.view.find('which').hidden = !text;
  }

  shown({turn, rests}) {
    if (this.shows) this.say('');   // the new picture is on the screen
    const now = performance.now(), {rest} = this;
    if (rest && rest.turn !== turn) {
      if (!this.before || now - rest.since > PAUSE_MS) this.before = rest;
      this.rest = null;
    }
    const since = this.rest?.since ?? now;   // also if the same picture comes once more, with a tint
    if (rests) this.rest = {turn, since, sheet: this.view.picture.sheet, words: ''};
    this.update(this.view.state);
    this.button.disabled = !this.before;
  }

  /** The numbers of a picture may come after it. */
  update({read, readings}) {
    if (this.rest?.turn === read) this.rest.words = wordsOf(readings);
  }
}

function wordsOf(r) {
  const stop = r.f_stop === null ? [] : [`f/${Number(r.f_stop.toPrecision(2))}`, metres(r.focus_m)];
  return [r.lens, ...stop, shutterLabel(r.shutter_s), `ISO ${Math.round(r.iso)}`].join(' · ');
}
