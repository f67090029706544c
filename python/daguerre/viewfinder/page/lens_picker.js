// lens_picker.js -- the dialog of lenses: search, years, drawings.

import {showSvg} from './dom.js';

export class LensPicker {
  /** `ask(message)` asks the server, `take(name)` uses the lens; null: the scene's. */
  constructor(root, ask, take) {
    this.find = (id) => root.getElementById(id);
    this.ask = ask;
    this.take = take;
    this.lenses = [];
    this.shown = [];   // those that the server has found, or all
    this.chosen = null;
    this.find('lens').addEventListener('click', () => this.open());
    this.find('lenses-close').addEventListener('click', () => this.dialog.close());
    this.find('lens-search').addEventListener('input', () => this.search());
    this.find('lens-take').addEventListener('click', () => this.use());
    this.find('lens-list').addEventListener('keydown', (event) => this.key(event));
  }

  get dialog() {
    return this.find('lenses');
  }

  offer(lenses) {
    this.lenses = [{name: null, title: 'as in the scene', year: null}, ...lenses];
    this.search();
  }

  /** Names the lens on the button. */
  show(name, used) {
    const own = this.lenses.find((lens) => lens.name === (name ?? null));
    this.find('lens').textContent = name ? own?.title ?? name : `as in the scene (${used ?? '?'})`;
    if (!this.dialog.open) this.chosen = name ?? null;
  }

  open() {
    this.dialog.showModal();
    this.search();
    this.find('lens-search').focus();
  }

  get words() {
    return this.find('lens-search').value.trim();
  }

  /** Lists all lenses, or asks the server for those that have the words. */
  search() {
    if (this.words) this.ask({find: this.words});
    else this.list(this.lenses, '');
  }

  found({words, names, all}) {
    if (words !== this.words) return;   // the user has typed on
    const lenses = names.map((name) => this.lenses.find((lens) => lens.name === name));
    const count = `${names.length} ${names.length === 1 ? 'lens' : 'lenses'}`;
    const none = 'No lens has all these words.';
    this.list(lenses, all ? count : names.length ? `${none} Nearest:` : none);
  }

  list(lenses = this.shown, count = this.find('lens-count').textContent) {
    this.shown = lenses;
    this.find('lens-count').textContent = count;
    const rows = lenses.map((lens) => {
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
    if (lens.drawn) this.ask({drawing: lens.name});
  }

  key(event) {
    const found = this.shown;
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
