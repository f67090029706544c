// lens_cards.js -- the grid of lenses: a card each, with a photograph that is fetched when it comes into view.

const NONE = {scene: 'the scene’s own', ideal: 'without glass', missing: 'no picture'};

export class LensCards {
  /** `choose(lens)` and `use()` act on a click and a double click. */
  constructor(view, choose, use) {
    this.view = view;
    this.box = view.find('lens-list');
    this.choose = choose;
    this.box.addEventListener('dblclick', (event) => event.target.closest('[role=option]') && use());
    this.shown = [];
    this.cards = new Map();
    this.photographs = new Map();   // those that came by message, as addresses
    this.waiting = new Map();       // images that wait for them
    this.sees = new IntersectionObserver((seen) => {
      for (const {isIntersecting, target} of seen) if (isIntersecting) this.ask(target);
    }, {root: this.box, rootMargin: '200px'});
  }

  make(lenses) {
    this.sees.disconnect();
    this.cards = new Map(lenses.map((lens) => [lens.name, this.card(lens)]));
  }

  card(lens) {
    const card = document.createElement('div');
    card.setAttribute('role', 'option');
    card.id = `lens-${lens.name ?? 'scene'}`;
    const photograph = document.createElement('div');
    this.photograph(photograph, lens, true);
    const title = document.createElement('span'), facts = document.createElement('small');
    title.textContent = lens.title;
    facts.textContent = [lens.shown, lens.year].filter(Boolean).join(' · ');
    card.setAttribute('aria-label', [lens.title, facts.textContent].filter(Boolean).join(', '));
    card.append(photograph, title, facts);
    card.addEventListener('click', () => this.choose(lens));
    return card;
  }

  show(lenses, chosen) {
    this.shown = lenses;
    this.box.replaceChildren(...lenses.map((lens) => this.cards.get(lens.name)));
    this.mark(chosen);
  }

  has(name) {
    return this.shown.some((lens) => lens.name === name);
  }

  mark(chosen) {
    for (const [name, card] of this.cards) card.setAttribute('aria-selected', name === chosen);
    const card = this.has(chosen) && this.cards.get(chosen);
    this.box.removeAttribute('aria-activedescendant');
    if (!card) return;
    this.box.setAttribute('aria-activedescendant', card.id);
    card.scrollIntoView({block: 'nearest'});
  }

  /** Lens that a key leads to in the grid; undefined: none. */
  next(key, chosen) {
    const at = this.shown.findIndex((lens) => lens.name === chosen), last = this.shown.length - 1;
    const columns = getComputedStyle(this.box).gridTemplateColumns.split(' ').length;
    const step = {ArrowRight: 1, ArrowLeft: -1, ArrowDown: columns, ArrowUp: -columns}[key];
    const goal = {Home: 0, End: last}[key] ?? (step && (at < 0 ? 0 : at + step));
    return this.shown[goal];
  }

  // Photographs

  /** Shows the photograph of a lens in a box, or says why there is none; `waits`: once it is in view. */
  photograph(box, lens, waits = false) {
    box.className = 'lens-photograph';
    if (!lens.photograph) {
      box.textContent = NONE[lens.name === null ? 'scene' : lens.kinds?.includes('ideal') ? 'ideal' : 'missing'];
      return;
    }
    const image = document.createElement('img');
    image.alt = `Head, chart and lanterns, rendered through ${lens.title}`;
    image.dataset.lens = lens.name;
    image.addEventListener('error', () => (box.textContent = NONE.missing));
    box.replaceChildren(image);
    if (waits) this.sees.observe(image);
    else this.ask(image);
  }

  /** Fetches a photograph, by message where no server has it as a file. */
  ask(image) {
    const {lens} = image.dataset;
    this.sees.unobserve(image);
    const address = this.view.link.photograph?.(lens) ?? this.photographs.get(lens);
    if (address) {
      image.src = address;
      return;
    }
    if (!this.waiting.has(lens)) this.view.send({photograph: lens});
    this.waiting.set(lens, [...this.waiting.get(lens) ?? [], image]);
  }

  got({name, webp}) {
    const bytes = Uint8Array.from(atob(webp), (one) => one.charCodeAt(0));
    this.photographs.set(name, URL.createObjectURL(new Blob([bytes], {type: 'image/webp'})));
    for (const image of this.waiting.get(name) ?? []) image.src = this.photographs.get(name);
    this.waiting.delete(name);
  }
}
