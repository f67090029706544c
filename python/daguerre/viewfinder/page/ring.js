// ring.js -- a ring of the camera: an engraved scale that slides under a fixed mark.
//
// The input is a native slider over the drawing, so that mouse, touch, keys and screen readers work
// as everywhere; the wheel and dragging the scale itself are added.

import {title} from './dom.js';

const PX_PER_RING = 900;   // length of a whole ring, unrolled
const PX_PER_LETTER = 7;
const LABEL_GAP = 5;
const NEAR = 0.25;   // a click this near to where the ring was found gives way to it, in steps
const HINT = 'Drag, turn the wheel, or use the arrow keys';
const LARGE = 5;     // steps of Page Up, and of the wheel with Shift
const SVG = 'http://www.w3.org/2000/svg';

/**
 * A ring clicks at the marks of its scale, and where it was found: a value between two marks, or one
 * that the scene has. So as many steps up as down give back the same picture, to the bit.
 */
export class Ring {
  /** `turned(texts)` is called with the texts of its dials at each click; null: as in the scene. */
  constructor(element, name, turned) {
    this.element = element;
    this.name = name;
    this.turned = turned;
    this.scale = null;
    this.holds = false;   // stays where it was turned to
    this.home = null;     // where it was found: value, texts of its dials
    this.sent = '';       // texts that it was turned to
    element.classList.add('ring');
    element.innerHTML = `
      <div class="ring-head"><label for="ring-${name}"></label><output></output></div>
      <div class="barrel"><svg aria-hidden="true"></svg><input type="range" id="ring-${name}"></div>
      <button type="button" class="back" title="As it was when the viewfinder opened" disabled>↺</button>`;
    this.label = element.querySelector('label');
    this.label.textContent = element.dataset.label;
    this.output = element.querySelector('output');
    this.back = element.querySelector('.back');
    this.back.setAttribute('aria-label', `${element.dataset.label}: as opened`);
    this.svg = element.querySelector('svg');
    this.input = element.querySelector('input');
    this.input.addEventListener('input', () => this.move(Number(this.input.value)));
    this.input.addEventListener('wheel', (event) => this.wheel(event), {passive: false});
    this.drag();
    this.width = 300;
    new ResizeObserver(([{contentRect}]) => this.resize(contentRect.width)).observe(element.querySelector('.barrel'));
    this.back.addEventListener('click', () => this.turned(this.opened));
  }

  /**
   * Engraves another scale.
   *
   * `dial`: dial that it turns. `texts`: texts of all dials that set its value, now; `opened`: at
   * first. `span`: pair of values around the mark, such as the depth of field. `off`: why it cannot
   * be turned. `metered`: letter of the exposure mode that turns it.
   */
  show(scale, value, {dial, texts, opened, span = null, off = '', metered = '', extra = ''}) {
    Object.assign(this, {scale, dial, texts, opened, span, extra});
    const now = JSON.stringify(texts);
    this.input.min = scale.low;
    this.input.max = scale.high;
    this.input.step = 'any';
    this.input.disabled = off !== '';
    this.element.classList.toggle('off', off !== '');
    this.element.classList.toggle('metered', metered !== '');
    this.label.dataset.metered = metered;
    title(this.input, off || HINT);
    this.back.disabled = off !== '' || now === JSON.stringify(opened);
    if (!this.busy && !this.holds) {
      if (now !== this.sent || now === JSON.stringify(this.home?.texts)) this.home = {value, texts};
      this.value = value;
      this.place(scale.position(value));
    }
    this.draw();
  }

  place(position) {
    const {low, high} = this.scale;
    this.position = Math.min(high, Math.max(low, position));
    this.input.value = this.position;
    const label = this.scale.label(this.value);
    this.output.textContent = this.extra ? `${label} · ${this.extra}` : label;
    this.input.setAttribute('aria-valuetext', this.output.textContent);
  }

  /** Forgets where it was found, as the same value has another name now. */
  forget() {
    this.home = null;
    this.sent = '';
  }

  /** Positions where it clicks. */
  clicks() {
    const {low, high, step} = this.scale;
    const home = this.homePosition;
    const found = [home];
    for (let i = 0; low + i * step < high + step * (1 - NEAR); i++) {
      const position = Math.min(high, low + i * step);
      if (Math.abs(position - home) > NEAR * step) found.push(position);
    }
    return found.sort((a, b) => a - b);
  }

  get homePosition() {
    const {low, high} = this.scale;
    return Math.min(high, Math.max(low, this.scale.position(this.home.value)));
  }

  /** Goes to the click nearest to a position, and on by a number of clicks. */
  move(position, steps = 0) {
    const clicks = this.clicks();
    const away = clicks.map((one) => Math.abs(one - position));
    const index = away.indexOf(Math.min(...away)) + steps;
    const to = clicks[Math.min(clicks.length - 1, Math.max(0, index))];
    const comesHome = to === this.homePosition;
    const value = comesHome ? this.home.value : this.scale.value(to);
    if (value === this.value && to === this.position) return;
    this.value = value;
    this.place(to);
    this.draw();
    this.holds = true;
    const none = Object.fromEntries(Object.keys(this.texts).map((name) => [name, null]));
    const texts = comesHome ? this.home.texts : {...none, [this.dial]: this.scale.text(value)};
    this.sent = JSON.stringify(texts);
    this.turned(texts);
  }

  /** Turns by clicks; to the right is up, except on a reversed scale. */
  step(count) {
    this.move(this.position, this.scale.reversed ? -count : count);
  }

  wheel(event) {
    if (this.input.disabled) return;
    event.preventDefault();
    this.step(-Math.sign(event.deltaY || event.deltaX) * (event.shiftKey ? LARGE : 1));
  }

  /** Dragging turns the ring: the scale follows the finger. */
  drag() {
    let from = null;
    this.input.addEventListener('pointerdown', (event) => {
      if (this.input.disabled) return;
      event.preventDefault();
      this.input.focus();
      this.input.setPointerCapture(event.pointerId);
      from = {x: event.clientX, position: this.position};
      this.busy = true;
    });
    this.input.addEventListener('pointermove', (event) => {
      if (from === null) return;
      const {low, high} = this.scale;
      const way = this.scale.reversed ? 1 : -1;
      this.move(from.position + (way * (event.clientX - from.x) * (high - low)) / PX_PER_RING);
    });
    const end = () => {
      from = null;
      this.busy = false;
    };
    this.input.addEventListener('pointerup', end);
    this.input.addEventListener('pointercancel', end);
    this.input.addEventListener('keydown', (event) => {
      const keys = {ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: LARGE, PageDown: -LARGE};
      if (!(event.key in keys)) return;
      event.preventDefault();
      if (!this.input.disabled) this.step(keys[event.key]);
    });
  }

  resize(width) {
    this.width = width;
    if (this.scale) this.draw();
  }

  draw() {
    const {low, high, marks, reversed} = this.scale, {width} = this;
    const way = (reversed ? -1 : 1) * PX_PER_RING / (high - low);
    const x = (value) => width / 2 + way * (this.scale.position(value) - this.position);
    const parts = [];
    if (this.span) {
      const [a, b] = this.span.map((v) => Math.min(width, Math.max(0, x(v ?? Infinity))));
      parts.push(part('rect', {x: Math.min(a, b), y: 30, width: Math.abs(b - a), height: 4, class: 'span'}));
    }
    let free = -Infinity;   // where the next label may begin, from where the ring begins
    for (const mark of marks) {
      const at = x(mark.value), half = mark.label.length * PX_PER_LETTER / 2;
      const along = Math.abs(at - x(marks[0].value));
      const fits = mark.label && along - half > free;   // the same labels wherever the ring stands
      if (fits) free = along + half + LABEL_GAP;
      if (at < 0 || at > width) continue;
      parts.push(part('line', {x1: at, x2: at, y1: mark.full ? 18 : 23, y2: 28, class: 'tick'}));
      if (fits && at > half && at + half < width) parts.push(part('text', {x: at, y: 13, class: 'mark'}, mark.label));
    }
    parts.push(part('line', {x1: width / 2, x2: width / 2, y1: 16, y2: 36, class: 'index'}));
    this.svg.replaceChildren(...parts);
  }
}

/** An element of SVG. */
export function part(name, attributes, text = '') {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.textContent = text;
  return made;
}
