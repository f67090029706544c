// lens_filters.js -- words and filters of the lens picker; a lens must fit all of them.

import {fill} from './dom.js';

const ANY = ['', 'any'];
/** Kinds as the library names them; the speed has a filter of its own. */
const KINDS = {
  zoom: 'Zoom', prime: 'Prime', ultrawide: 'Ultra-wide', wide: 'Wide angle', normal: 'Normal', portrait: 'Portrait',
  tele: 'Telephoto', supertele: 'Super telephoto', fisheye: 'Fisheye', macro: 'Macro', soft: 'Soft focus',
  anamorphic: 'Anamorphic', cine: 'Cine', bokeh: 'Strong blur', fullframe: 'Full frame', apsc: 'APS-C',
  mft: 'Micro four thirds', s35: 'Super 35', medium: 'Medium format', large: 'Large format', ideal: 'Without glass',
};
/** Where the ranges of focal lengths begin, mm. */
const LENGTHS = [0, 21, 35, 71, 136, 301, Infinity];
const SPEEDS = [1.4, 2, 2.8, 4];
const OLD = 1950;   // older lenses are few: one era

/** Filters by the id of their select: whether a lens fits a value. */
const FITS = {
  'lens-kind': (lens, kind) => lens.kinds.includes(kind),
  'lens-length': (lens, at) => lens.focal_mm && lens.focal_mm[0] < LENGTHS[Number(at) + 1] && lens.focal_mm[1] >= LENGTHS[at],
  'lens-speed': (lens, stop) => lens.f_number <= stop,
  'lens-era': (lens, from) => era(lens) === Number(from),
  'lens-maker': (lens, maker) => lens.makers.includes(maker),
};

export class LensFilters {
  /** `changed()` is called after each change. */
  constructor({find}, changed) {
    this.find = find;
    this.changed = () => {
      const {active} = this;
      find('lens-reset').disabled = !active && !this.words;
      find('lens-more').textContent = active ? `Filters (${active})` : 'Filters';
      changed();
    };
    find('lens-search').addEventListener('input', this.changed);
    for (const id of Object.keys(FITS)) find(id).addEventListener('change', this.changed);
    find('lens-reset').addEventListener('click', () => this.reset());
    find('lens-more').addEventListener('click', () => this.open());
  }

  get words() {
    return this.find('lens-search').value.trim();
  }

  /** Number of filters that are set. */
  get active() {
    return Object.keys(FITS).filter((id) => this.find(id).value).length;
  }

  /** Fills the menus of the filters from the facts of the lenses. */
  know(lenses) {
    const known = lenses.filter((lens) => lens.kinds);
    const kinds = new Set(known.flatMap((lens) => lens.kinds));
    const eras = [...new Set(known.filter((lens) => lens.year).map(era))].sort();
    const makers = [...new Set(known.flatMap((lens) => lens.makers))].sort((a, b) => a.localeCompare(b));
    fill(this.find('lens-kind'), [ANY, ...Object.entries(KINDS).filter(([kind]) => kinds.has(kind))]);
    fill(this.find('lens-length'), [ANY, ...LENGTHS.slice(0, -1).map((from, i) => [i, lengthOf(from, LENGTHS[i + 1])])]);
    fill(this.find('lens-speed'), [ANY, ...SPEEDS.map((stop) => [stop, `f/${stop} or faster`])]);
    fill(this.find('lens-era'), [ANY, ...eras.map((from) => [from, from ? `${from}s` : `before ${OLD}`])]);
    fill(this.find('lens-maker'), [ANY, ...makers.map((maker) => [maker, maker])]);
    for (const id of Object.keys(FITS)) this.find(id).value ||= '';
  }

  fits(lens) {
    return lens.kinds !== undefined && Object.entries(FITS).every(([id, fits]) => {
      const value = this.find(id).value;
      return !value || fits(lens, value);
    });
  }

  reset() {
    this.find('lens-search').value = '';
    for (const id of Object.keys(FITS)) this.find(id).value = '';
    this.changed();
    this.find('lens-search').focus();
  }

  /** Shows the filters, or hides them, on a phone. */
  open() {
    const button = this.find('lens-more');
    button.setAttribute('aria-expanded', button.getAttribute('aria-expanded') !== 'true');
  }
}

/** First year of a lens's decade; 0: it is older. */
function era({year}) {
  return year ? (year < OLD ? 0 : year - year % 10) : undefined;
}

function lengthOf(from, to) {
  if (!from) return `up to ${to - 1} mm`;
  return to === Infinity ? `over ${from - 1} mm` : `${from} to ${to - 1} mm`;
}
