// needle.js -- the strip of the viewfinder: mode, time, stop and ISO, and a needle against the meter.

import {letterOf} from './mode_dial.js';
import {part} from './ring.js';
import {shutterLabel} from './scales.js';

const END = 3;              // stops from the meter to either end of the scale
const LEFT = 20, STOP = 30; // px
const SIZE = 2 * (LEFT + END * STOP);
const x = (stops) => SIZE / 2 + stops * STOP;

export class Needle {
  constructor({find}) {
    this.find = find;
    find('needle').prepend(engraved());
  }

  update({mode, readings: r}) {
    if (!r.lens) return;
    this.find('settings').replaceChildren(...textsOf(mode, r).map((text) => {
      const made = document.createElement('span');
      made.textContent = text;
      return made;
    }));
    this.point(r.meter ? r.meter.over : null);
  }

  /** Shows so many stops over the meter; null: there is no light to meter. */
  point(over) {
    const needle = this.find('needle'), text = inWords(over);
    needle.setAttribute('aria-valuenow', Math.min(END, Math.max(-END, over ?? 0)).toFixed(2));
    needle.setAttribute('aria-valuetext', text);
    needle.title = `How bright the picture is: ${text}`;
    needle.lastElementChild.textContent = over === null ? 'no light' : signed(over);
    const pointer = needle.querySelector('.pointer');
    pointer.toggleAttribute('hidden', over === null);
    const beyond = Math.abs(over ?? 0) > END;
    pointer.setAttribute('d', beyond ? arrow(Math.sign(over)) : `M${x(over ?? 0)} 15l5 9h-10z`);
    pointer.classList.toggle('beyond', beyond);
  }
}

function textsOf(mode, {shutter_s: time, f_stop: stop, t_stop: transmitted, iso}) {
  const text = stop === null ? '' : `f/${Number(stop.toPrecision(2))}`;
  return [letterOf(mode), time > 0 ? shutterLabel(time) : '', text, `ISO ${Number(iso.toPrecision(3))}`].filter(Boolean);
}

/** An arrow at the end of the scale: the needle stands beyond it. */
function arrow(way) {
  const end = x(way * END) + way * 5;
  return `M${end} 12v12l${way * 11} -6z`;
}

function engraved() {
  const ticks = [];
  for (let third = -3 * END; third <= 3 * END; third++) {
    const at = x(third / 3), full = third % 3 === 0;
    ticks.push(part('line', {x1: at, x2: at, y1: full ? 9 : 11, y2: 14, class: 'tick'}));
    if (full) ticks.push(part('text', {x: at, y: 8, class: 'mark'}, signed(third / 3, 0)));
  }
  const svg = part('svg', {viewBox: `0 0 ${SIZE} 25`, 'aria-hidden': true});
  svg.append(...ticks, part('path', {class: 'pointer'}));
  return svg;
}

function signed(value, digits = 1) {
  const shown = Number(value.toFixed(digits)) || 0;
  return `${shown > 0 ? '+' : ''}${shown.toFixed(digits)}`.replace('-', '−');
}

function inWords(over) {
  if (over === null) return 'no light to meter';
  const stops = Number(Math.abs(over).toFixed(1));
  if (stops === 0) return 'as the meter wants it';
  return `${signed(over)} ${stops === 1 ? 'stop' : 'stops'} ${over > 0 ? 'over' : 'under'} the meter`;
}
