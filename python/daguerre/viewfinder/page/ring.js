// ring.js -- a ring of the camera: an engraved scale that slides under a fixed mark.
//
// The input is a native slider over the drawing, so that mouse, touch, keys and screen readers work
// as everywhere; the wheel and dragging the scale itself are added.

const PX_PER_RING = 900;   // length of a whole ring, unrolled
const PX_PER_LETTER = 7;
const SVG = 'http://www.w3.org/2000/svg';

export class Ring {
  /** `turned(text)` is called with each new value; null: back to the scene's. */
  constructor(element, name, turned) {
    this.element = element;
    this.name = name;
    this.turned = turned;
    this.scale = null;
    this.holds = false;   // stays where it was turned to
    element.classList.add('ring');
    element.innerHTML = `
      <div class="ring-head"><label for="ring-${name}"></label><output></output>
        <button type="button" class="back" title="As in the scene" hidden>↺</button></div>
      <div class="barrel"><svg aria-hidden="true"></svg><input type="range" id="ring-${name}"></div>`;
    this.label = element.querySelector('label');
    this.label.textContent = element.dataset.label;
    this.output = element.querySelector('output');
    this.back = element.querySelector('.back');
    this.back.setAttribute('aria-label', `${element.dataset.label}: as in the scene`);
    this.svg = element.querySelector('svg');
    this.input = element.querySelector('input');
    this.input.addEventListener('input', () => this.move(Number(this.input.value)));
    this.input.addEventListener('wheel', (event) => this.wheel(event), {passive: false});
    this.drag();
    this.back.addEventListener('click', () => this.turned(null));
  }

  /** Engraves another scale; `span` is a pair of values around the mark, such as the depth of field. */
  show(scale, value, {span = null, own = false, disabled = false, extra = ''} = {}) {
    this.scale = scale;
    this.span = span;
    this.extra = extra;
    this.input.min = scale.low;
    this.input.max = scale.high;
    this.input.step = 'any';
    this.input.disabled = disabled;
    this.back.hidden = !own;
    if (!this.busy && !this.holds) {
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

  move(position) {
    const {low, high, step} = this.scale;
    const stepped = Math.min(high, Math.max(low, low + Math.round((position - low) / step) * step));
    const value = this.scale.value(stepped);
    if (value === this.value && stepped === this.position) return;
    this.value = value;
    this.place(stepped);
    this.draw();
    this.holds = true;
    this.turned(this.scale.text(value));
  }

  wheel(event) {
    if (this.input.disabled) return;
    event.preventDefault();
    const way = this.scale.reversed ? -1 : 1;
    this.move(this.position + way * Math.sign(event.deltaY || event.deltaX) * -this.scale.step * (event.shiftKey ? 5 : 1));
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
      const keys = {ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 5, PageDown: -5};
      if (!(event.key in keys)) return;
      event.preventDefault();
      const way = this.scale.reversed ? -1 : 1;
      this.move(this.position + way * keys[event.key] * this.scale.step);
    });
  }

  draw() {
    const {low, high, marks, reversed} = this.scale;
    const way = reversed ? -1 : 1;
    const x = (position) => 50 + (way * (position - this.position) * PX_PER_RING * 100) / (high - low) / this.width();
    const parts = [];
    if (this.span) {
      const [a, b] = this.span.map((v) => x(this.scale.position(v ?? Infinity)));
      parts.push(part('rect', {x: `${Math.min(a, b)}%`, y: 30, width: `${Math.abs(b - a)}%`, height: 4, class: 'span'}));
    }
    for (const mark of marks) {
      const at = x(this.scale.position(mark.value));
      if (at < -5 || at > 105) continue;
      parts.push(part('line', {x1: `${at}%`, x2: `${at}%`, y1: mark.full ? 18 : 23, y2: 28, class: 'tick'}));
      if (mark.label && this.fits(mark.label, at)) parts.push(part('text', {x: `${at}%`, y: 13, class: 'mark'}, mark.label));
    }
    parts.push(part('line', {x1: '50%', x2: '50%', y1: 16, y2: 36, class: 'index'}));
    this.svg.replaceChildren(...parts);
  }

  /** Whether no edge cuts a label, centred at a percentage of the width. */
  fits(label, at) {
    const half = (100 * label.length * PX_PER_LETTER) / 2 / this.width();
    return at - half > 0 && at + half < 100;
  }

  width() {
    return this.svg.clientWidth || 300;
  }
}

function part(name, attributes, text = '') {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.textContent = text;
  return made;
}
