// lens_picker.js -- the dialog of lenses: search, years, drawings.

import {showSvg} from './dom.js';

export class LensPicker {
  /** `ask(name)` wants a lens's drawing, `take(name)` uses the lens; null: the scene's. */
  constructor(root, ask, take) {
    this.find = (id) => root.getElementById(id);
    this.ask = ask;
    this.take = take;
    this.lenses = [];
    this.chosen = null;
    this.find('lens').addEventListener('click', () => this.open());
    this.find('lenses-close').addEventListener('click', () => this.dialog.close());
    this.find('lens-search').addEventListener('input', () => this.list());
    this.find('lens-take').addEventListener('click', () => this.use());
    this.find('lens-list').addEventListener('keydown', (event) => this.key(event));
  }

  get dialog() {
    return this.find('lenses');
  }

  offer(lenses) {
    this.lenses = [{name: null, title: 'as in the scene', year: null}, ...lenses];
    this.list();
  }

  /** Names the lens on the button. */
  show(name, used) {
    const own = this.lenses.find((lens) => lens.name === (name ?? null));
    this.find('lens').textContent = name ? own?.title ?? name : `as in the scene (${used ?? '?'})`;
    if (!this.dialog.open) this.chosen = name ?? null;
  }

  open() {
    this.dialog.showModal();
    this.list();
    this.find('lens-search').focus();
  }

  matches() {
    const words = this.find('lens-search').value.toLowerCase().split(/\s+/);
    return this.lenses.filter((lens) => {
      const text = `${lens.name ?? ''} ${lens.title} ${lens.year ?? ''}`.toLowerCase();
      return words.every((word) => text.includes(word));
    });
  }

  list() {
    const rows = this.matches().map((lens) => {
      const row = document.createElement('div');
      row.setAttribute('role', 'option');
      row.setAttribute('aria-selected', lens.name === this.chosen);
      row.id = `lens-${lens.name ?? 'scene'}`;
      row.append(document.createElement('span'), document.createElement('small'));
      row.firstChild.textContent = lens.title;
      row.lastChild.textContent = lens.year ?? '';
      row.addEventListener('click', () => this.choose(lens));
      row.addEventListener('dblclick', () => this.use());
      return row;
    });
    const list = this.find('lens-list');
    list.replaceChildren(...rows);
    if (!rows.length) list.textContent = 'No lens has these words.';
    const own = list.querySelector('[aria-selected=true]');
    list.toggleAttribute('aria-activedescendant', false);
    if (own) list.setAttribute('aria-activedescendant', own.id);
  }

  choose(lens) {
    this.chosen = lens.name;
    this.list();
    this.find('lens-list').querySelector('[aria-selected=true]')?.scrollIntoView({block: 'nearest'});
    this.find('lens-drawing').removeAttribute('src');
    this.find('lens-facts').textContent = lens.title;
    if (lens.drawn) this.ask(lens.name);
  }

  key(event) {
    const found = this.matches();
    const at = found.findIndex((lens) => lens.name === this.chosen);
    const next = {ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: found.length - 1}[event.key];
    if (event.key === 'Enter') this.use();
    else if (next === undefined || !found[next]) return;
    else this.choose(found[next]);
    event.preventDefault();
  }

  drawn({name, svg, focal_length_mm: focal, f_stop: stop}) {
    if (name !== this.chosen) return;
    const lens = this.lenses.find((one) => one.name === name);
    const image = this.find('lens-drawing');
    showSvg(image, svg);
    image.alt = `Section of ${lens.title}`;
    const facts = [lens.title, lens.year, `${focal.toPrecision(3)} mm`, `f/${stop.toPrecision(2)}`];
    this.find('lens-facts').textContent = facts.filter(Boolean).join(' · ');
  }

  use() {
    this.take(this.chosen);
    this.dialog.close();
  }
}
