// loupe.js -- pixels under the pointer, their linear values, and how far the point is.

import {feet, metres} from './scales.js';

const PROBE_MS = 40;
const SIDE = 121, PIXELS = 11;

export class Loupe {
  constructor(view) {
    this.view = view;
    this.element = view.find('loupe');
    this.probed = 0;
    view.find('picture').addEventListener('pointermove', (event) => this.move(event));
    view.root.querySelector('[data-toggle=loupe]').addEventListener('click', () => (this.element.hidden = true));
  }

  move(event) {
    const {open, picture} = this.view;
    if (!picture.shows.loupe || !open || !picture.head) return;
    this.element.hidden = false;
    const {pixel, part, spot} = picture.at(event);
    const now = performance.now();
    if (now - this.probed > PROBE_MS) {
      this.probed = now;
      this.view.send({probe: [...pixel, part]});
    }
    this.draw(picture.canvas, spot);
  }

  draw(canvas, [x, y]) {
    const context = this.element.querySelector('canvas').getContext('2d');
    const corner = (v) => v - (PIXELS - 1) / 2;
    context.imageSmoothingEnabled = false;
    context.clearRect(0, 0, SIDE, SIDE);
    context.drawImage(canvas, corner(x), corner(y), PIXELS, PIXELS, 0, 0, SIDE, SIDE);
    context.strokeStyle = '#e8b84a';
    context.strokeRect(54.5, 54.5, 12, 12);
  }

  told(message) {
    if (!('value' in message)) return;
    const {value} = message, digits = (i) => value.rgb[i].toPrecision(4);
    this.element.querySelector('p').textContent = value
      ? `${value.x}, ${value.y}\nR ${digits(0)}\nG ${digits(1)}\nB ${digits(2)}\n${distance(value)}` : '';
  }
}

function distance({distance_m: m}) {
  return m === null ? '∞' : `${metres(m)} (${feet(m)})`;
}
