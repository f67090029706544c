// lens_picker.js -- the dialog to choose a lens: photographs, filters and the library's search.
//
// Another part may set `view.compareWith(name)`: the dialog then offers to compare the chosen lens.

import {showSvg} from './dom.js';
import {LensCards} from './lens_cards.js';
import {LensFilters} from './lens_filters.js';

const DRAWING_MS = 120;   // a drawing waits until the arrow keys rest

export class LensPicker {
  constructor(view) {
    this.view = view;
    this.find = view.find;
    this.titles = [];     // of all lenses: {name, title}
    this.lenses = null;   // with their facts, once the dialog has asked for them
    this.hits = null;     // lenses that the server found for the words; null: no answer yet
    this.chosen = null;
    this.cards = new LensCards(view, (lens) => this.choose(lens), () => this.use());
    this.filters = new LensFilters(view, () => this.search());
    const on = (id, event, act) => this.find(id).addEventListener(event, act);
    on('lens', 'click', () => this.open());
    view.pickOther = () => this.open(true);
    on('lens-take', 'click', () => this.take());
    on('lens-compare', 'click', () => this.compare());
    on('lens-back', 'click', () => this.openSheet(false));
    on('lens-search', 'keydown', (event) => this.leaveSearch(event));
    on('lens-list', 'keydown', (event) => this.key(event));
  }

  get dialog() {
    return this.find('lenses');
  }

  get lens() {
    return this.lenses?.find((lens) => lens.name === this.chosen);
  }

  // Messages of the server

  opened({lenses}) {
    this.titles = [{name: null, title: 'as in the scene'}, ...lenses];
    this.lenses = this.hits = null;
    if (this.dialog.open) this.view.send({facts: true});
  }

  update({dials, readings}) {
    const name = dials.lens ?? null;
    const title = this.titles.find((lens) => lens.name === name)?.title ?? name;
    this.find('lens').textContent = name ? title : `as in the scene (${readings.lens ?? '?'})`;
    this.find('lens-take').disabled = !this.view.mine;
    if (!this.dialog.open) this.chosen = name;
  }

  told({facts, found, drawing, photograph}) {
    if (facts) this.know(facts);
    if (found && found.words === this.filters.words) this.list(found);   // else the user has typed on
    if (drawing) this.drawn(drawing);
    if (photograph) this.cards.got(photograph);
  }

  know(facts) {
    const byName = new Map(facts.map((lens) => [lens.name, lens]));
    this.lenses = this.titles.map((lens) => ({...lens, ...byName.get(lens.name)}));
    this.filters.know(this.lenses);
    this.cards.make(this.lenses);
    this.search();
    if (this.lens) this.show(this.lens);
  }

  // The list

  /** Opens the dialog, to choose the camera's lens or a lens to compare with it. */
  open(compares = false) {
    this.compares = compares;
    this.find('lens-take').hidden = compares;
    this.dialog.showModal();
    this.openSheet(false);
    this.find('lens-compare').hidden = !this.view.compareWith;
    if (!this.lenses) this.view.send({facts: true});
    else if (this.lens) this.show(this.lens);
    // On a touch screen the search would raise the keyboard over the list.
    this.find(matchMedia('(pointer: coarse)').matches ? 'lens-list' : 'lens-search').focus();
  }

  /** Lists all lenses, or asks the server for those that have the words. */
  search() {
    const {words} = this.filters;
    if (words && words !== this.hits?.words) this.view.send({find: words});
    else this.list(words ? this.hits : null);
  }

  list(hits) {
    this.hits = hits;
    if (!this.lenses) return;
    const lenses = hits ? hits.names.map((name) => this.lenses.find((lens) => lens.name === name)) : this.lenses;
    const fitting = this.filters.active ? lenses.filter((lens) => this.filters.fits(lens)) : lenses;
    this.find('lens-count').textContent = countOf(fitting, hits);
    this.cards.show(fitting, this.chosen);
  }

  key(event) {
    const next = this.cards.next(event.key, this.chosen);
    if (event.key === 'Enter' && this.cards.has(this.chosen)) this.use();
    else if (next) this.choose(next);
    else return;
    event.preventDefault();
  }

  leaveSearch(event) {
    const first = this.cards.shown[0];
    if (!['Enter', 'ArrowDown'].includes(event.key) || !first) return;
    event.preventDefault();
    if (!this.cards.has(this.chosen)) this.choose(first);
    this.find('lens-list').focus();
  }

  // The chosen lens

  choose(lens) {
    this.chosen = lens.name;
    this.cards.mark(this.chosen);
    this.openSheet(true);
    this.show(lens);
  }

  /** Opens the chosen lens over the list, where there is no room beside it. */
  openSheet(opens) {
    this.dialog.classList.toggle('sheet', opens);
  }

  show(lens) {
    this.cards.mark(lens.name);
    this.find('lens-chosen').hidden = false;
    this.find('lens-title').textContent = lens.title;
    this.cards.photograph(this.find('lens-photograph'), lens);
    this.find('lens-drawing').removeAttribute('src');
    this.facts(lens, {});
    this.find('lens-compare').disabled = lens.name === null || !this.view.mine;
    clearTimeout(this.asks);
    if (lens.photograph !== undefined) this.asks = setTimeout(() => this.view.send({drawing: lens.name}), DRAWING_MS);
  }

  drawn({name, svg, focal_length_mm: focal, f_stop: stop, about}) {
    if (name !== this.chosen) return;
    const image = this.find('lens-drawing');
    showSvg(image, svg);
    image.alt = `Section of ${this.lens.title}`;
    this.facts(this.lens, {'Focal length': `${focal.toPrecision(3)} mm`, 'Widest stop': `f/${Number(stop.toPrecision(3))}`,
      ...about});
  }

  facts(lens, rows) {
    this.find('lens-facts').replaceChildren(...Object.entries(rows).map(([label, text]) => {
      const row = document.createElement('div');
      row.append(document.createElement('dt'), document.createElement('dd'));
      row.firstChild.textContent = label;
      row.lastChild.textContent = text;
      return row;
    }));
  }

  use() {
    if (this.compares) this.compare();
    else this.take();
  }

  take() {
    if (this.find('lens-take').disabled) return;
    this.view.turn({lens: this.chosen});
    this.dialog.close();
  }

  compare() {
    if (this.find('lens-compare').disabled) return;
    this.view.compareWith(this.chosen);
    this.dialog.close();
  }
}

function countOf(lenses, hits) {
  if (hits && !hits.all) return `No lens has all these words.${lenses.length ? ' Nearest:' : ''}`;
  const count = lenses.filter((lens) => lens.name !== null).length;
  return count ? `${count} ${count === 1 ? 'lens' : 'lenses'}` : 'No lens fits all of this.';
}
