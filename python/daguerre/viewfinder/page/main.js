// main.js -- the panel: what the server tells becomes rings and numbers, what is turned goes back.

import {fill, press, pressed} from './dom.js';
import {LensPicker} from './lens_picker.js';
import {Picture, drawHistogram} from './picture.js';
import {Ring} from './ring.js';
import * as scales from './scales.js';
import {showSection} from './section.js';
import {Tripod} from './tripod.js';

const RINGS = [
  ['focus_distance', 'Focus'], ['f_stop', 'Aperture'], ['zoom', 'Zoom'], ['shutter_time', 'Shutter'],
  ['iso', 'ISO'], ['exposure_compensation', 'Exposure compensation'], ['white_balance', 'White balance'],
  ['blades', 'Iris blades'], ['time', 'Time'],
];
const SELECTS = {cameras: 'camera', sensor: 'sensor', look: 'look', 'shutter-type': 'shutter_type'};
const MODES = {
  light: 'Light: 1 is white', manual: 'Manual', auto: 'Auto: sets the ISO', A: 'A: sets the time', S: 'S: sets the f-stop',
  P: 'P: sets time and f-stop',
};
const METERS = {centre: 'Centre', spot: 'Spot: point in focus', matrix: 'Matrix', highlight: 'Highlights'};
const NONE = ['', 'as in the scene'];
const PROBE_MS = 40;

/** Runs the panel in a document or shadow root; `makeLink(handlers)` connects it. */
export function mount(root, makeLink) {
  return new Panel(root, makeLink);
}

class Panel {
  constructor(root, makeLink) {
    this.root = root;
    this.find = (id) => root.getElementById(id);
    this.open = null;    // what the stage offers: lenses, sensors, cameras, times
    this.state = null;   // dials and readings
    this.mine = false;   // whether this page may turn
    this.wish = null;
    this.unheard = 0;    // turns that the server has not taken yet
    this.rings = {};
    const canvas = this.find('picture');
    this.picture = new Picture(canvas, this.find('over'));
    this.tripod = new Tripod(canvas, (dials) => this.turn(dials));
    this.lenses = new LensPicker(root, (message) => this.link.send(message), (name) => this.turn({lens: name}));
    this.link = makeLink({
      told: (message) => this.told(message),
      picture: (head, bytes) => this.shown(head, bytes),
      status: (text) => this.status(text),
    });
    this.listen();
  }

  /** Sends turns at most once a frame, the newest of each dial. */
  turn(dials) {
    const waits = this.wish !== null;
    this.wish = {...this.wish, ...dials};
    if (waits) return;
    requestAnimationFrame(() => {
      this.link.send({turn: this.wish});
      this.unheard++;
      this.wish = null;
    });
  }

  /** Whether the readings are those of all that was turned; if not, what was turned stays where it is. */
  get current() {
    return this.wish === null && this.unheard === 0 && (this.state.read === this.state.turn || this.state.error !== '');
  }

  told(message) {
    if (message.open) this.opened(message.open);
    if (message.heard) this.unheard--;
    if (message.role || message.refused) this.unheard = 0;
    if (message.role) this.mine = message.role === 'turns';
    if (message.role === 'watches') this.status('Watching: another page turns the rings');
    if (message.state) {
      this.state = message.state;
    }
    if (this.open && this.state && (message.state || message.heard || message.refused)) this.update();
    if (message.refused) this.complain(message.refused);
    if ('value' in message) this.loupeValue(message.value);
    if (message.section) showSection(this.find, message.section);
    if (message.drawing) this.lenses.drawn(message.drawing);
    if (message.found) this.lenses.found(message.found);
    if (message.saved) this.find('saved').textContent = `Saved ${message.saved}`;
    if (message.changed) {
      this.find('changed').hidden = false;
      this.find('changed').firstElementChild.textContent = `${message.changed} has changed.`;
    }
  }

  async shown(head, bytes) {
    const fresh = await this.picture.show(head, bytes);
    this.link.send({got: head.picture});
    if (!fresh) return;
    Object.assign(this.find('frame').dataset, {picture: head.picture, turn: head.turn, rests: head.rests});
    const [width, height] = head.size, most = this.open?.spp ?? head.samples;
    this.status(head.rests ? `${head.samples} samples` : `${width} × ${height}, ${head.samples} of ${most} samples`);
    this.find('progress').value = head.rests ? 1 : head.samples / most;
    this.find('names').replaceChildren(...head.panels.map((name) => {
      const label = document.createElement('span');
      label.textContent = name;
      return label;
    }));
    drawHistogram(this.find('histogram'), head.histogram);
  }

  status(text) {
    this.find('status').textContent = text;
  }

  complain(text) {
    this.find('error').textContent = text;
    this.find('error').hidden = !text;
  }

  opened(found) {
    this.open = found;
    this.find('scene').textContent = found.scene;
    if (this.root === document) document.title = `${found.scene}: Daguerre viewfinder`;
    this.find('changed').hidden = true;
    this.lenses.offer(found.lenses);
    const same = (names) => [NONE, ...names.map((name) => [name, name])];
    fill(this.find('cameras'), same(found.cameras));
    fill(this.find('sensor'), same(found.sensors));
    fill(this.find('look'), same(found.looks));
    fill(this.find('shutter-type'), same(found.shutter_types));
    fill(this.find('exposure'), found.modes.map((name) => [name, MODES[name]]));
    fill(this.find('iris-scale'), [['f3', 'f, third stops'], ['f2', 'f, half stops'], ['T3', 'T, third stops'],
      ['T2', 'T, half stops']]);
    if (!this.find('iris-scale').value) this.find('iris-scale').value = 'f3';
    this.root.querySelector('[data-show=denoised]').hidden = !found.denoises;
    this.find('play').hidden = !found.duration_s;
    this.engrave();
  }

  /** Makes the rings. */
  engrave() {
    if (Object.keys(this.rings).length) return;
    for (const [name, label] of RINGS) {
      const element = document.createElement('div');
      element.dataset.label = label;
      this.find('rings').append(element);
      this.rings[name] = new Ring(element, name, (texts) => this.turn(texts));
    }
  }

  get irisLetter() {
    return this.state?.readings.t_stop ? this.find('iris-scale').value[0] : 'f';
  }

  update() {
    const {dials, readings, command, error, show} = this.state;
    this.complain(error || (readings.warnings ?? []).join('; '));
    this.find('command').value = command;
    this.find('command').closest('div').hidden = this.root.querySelector('[for=command]').hidden = !command;
    for (const [id, dial] of Object.entries(SELECTS)) {
      this.select(id, dials[dial] ?? '');
    }
    this.updateExposure();
    for (const name of ['models', 'denoised']) press(this.root.querySelector(`[data-show=${name}]`), show[name]);
    this.lenses.show(dials.lens, readings.lens);
    if (this.root.activeElement !== this.find('spp')) this.find('spp').value = readings.spp ?? '';
    if (!readings.lens) return;
    this.open.spp = readings.spp;
    this.updateRings(dials, readings);
    this.find('hyperfocal').disabled = !this.mine || readings.hyperfocal_m === null;
    this.tripod.stand(readings.place, readings.focus_m, this.current);
    this.picture.lean(readings.place.roll, readings.place.forward, readings.field_of_view_deg[1]);
    this.numbers(readings);
  }

  /** Shows a value in a select, unless it is the user who chooses there. */
  select(id, value) {
    const element = this.find(id);
    if (this.current || this.root.activeElement !== element) element.value = value;
    element.disabled = !this.mine;
  }

  /** Mode and pattern; a pattern that is not offered, such as a spot on a node, was given. */
  updateExposure() {
    const {mode, pattern} = this.state, offered = this.open.meters;
    const patterns = offered.includes(pattern) ? offered : [...offered, pattern];
    fill(this.find('meter'), patterns.map((name) => [name, METERS[name] ?? name]));
    this.select('exposure', mode);
    this.select('meter', pattern);
    if (!['light', 'manual'].includes(mode)) this.automatic = mode;
    this.find('lock').disabled = !this.mine || mode === 'light';
    press(this.find('lock'), mode === 'manual');
  }

  updateRings(dials, readings) {
    const {rings, open, current} = this;
    for (const ring of Object.values(rings)) ring.holds &&= !current;
    const iris = readings.f_stop !== null;
    rings.focus_distance.show(scales.focusScale(readings.closest_m), readings.focus_m ?? Infinity, {
      ...this.ringOf('focus_distance', 'focus_at', 'focus_on'), ...(iris ? {} : {off: 'everything is sharp'}),
      span: iris ? [readings.near_m, readings.far_m ?? Infinity] : null,
    });
    rings.f_stop.element.hidden = rings.blades.element.hidden = !iris;
    if (iris) this.updateIris(readings);
    rings.zoom.element.hidden = !readings.zoom_range_mm;
    if (readings.zoom_range_mm) {
      rings.zoom.show(scales.zoomScale(readings.zoom_range_mm), readings.zoom_mm, this.ringOf('zoom'));
    }
    rings.shutter_time.show(scales.shutterScale(), readings.shutter_s || 1 / 8000, {
      ...this.ringOf('shutter_time', 'shutter_angle'),
      extra: this.beside('shutter_time', `${(360 * readings.fps * readings.shutter_s).toPrecision(3)}°`),
    });
    rings.iso.show(scales.isoScale(), readings.iso, {...this.ringOf('iso'), extra: this.beside('iso')});
    rings.exposure_compensation.show(scales.evScale(), readings.ev, this.ringOf('exposure_compensation'));
    rings.white_balance.show(scales.whiteScale(), readings.white_k ?? 6500, this.ringOf('white_balance'));
    rings.blades.show(scales.bladesScale(), readings.blades, this.ringOf('blades'));
    rings.time.element.hidden = !open.duration_s;
    if (open.duration_s) {
      rings.time.show(scales.timeScale(open.duration_s, readings.fps), readings.time_s, this.ringOf('time'));
    }
  }

  /** What a ring shows of its dials; the first one is what it turns. */
  ringOf(dial, ...others) {
    const names = [dial, ...others].sort();
    const of = (texts) => Object.fromEntries(names.map((name) => [name, texts[name] ?? null]));
    const {chosen, mode, dials} = this.state;
    const off = chosen.includes(dial) ? `The exposure mode ${mode} sets it; Manual lets you turn it`
      : this.mine ? '' : 'Another page turns the rings';
    return {dial, texts: of(dials), opened: of(this.open.dials), off};
  }

  /** Text beside the value of a ring that an exposure mode sets. */
  beside(dial, text = '') {
    return [text, this.state.chosen.includes(dial) ? this.state.mode : ''].filter(Boolean).join(' · ');
  }

  updateIris(readings) {
    const letter = this.irisLetter, perStop = Number(this.find('iris-scale').value[1]);
    const loss = readings.t_stop ? readings.t_stop / readings.f_stop : 1;
    const [value, widest] = letter === 'T' ? [readings.t_stop, readings.widest * loss] : [readings.f_stop, readings.widest];
    const other = letter === 'T' ? `f/${readings.f_stop.toPrecision(3)}`
      : readings.t_stop ? `T/${readings.t_stop.toPrecision(3)}` : '';
    this.rings.f_stop.show(scales.irisScale(widest, perStop, letter), value, {
      ...this.ringOf(letter === 'T' ? 't_stop' : 'f_stop', letter === 'T' ? 'f_stop' : 't_stop', 'aperture_diameter'),
      extra: this.beside('f_stop', other),
    });
  }

  numbers(r) {
    const {metres, feet} = scales;
    const rows = {
      Lens: r.lens,
      'Focal length': `${r.focal_length_mm.toPrecision(3)} mm`,
      'Field of view': `${r.field_of_view_deg[0].toFixed(1)}° × ${r.field_of_view_deg[1].toFixed(1)}°`,
      Focus: r.f_stop === null ? 'everything is sharp' : `${metres(r.focus_m)} (${feet(r.focus_m)})`,
      'Depth of field': r.near_m === null ? '' : `${metres(r.near_m)} to ${metres(r.far_m)}`,
      Hyperfocal: r.hyperfocal_m === null ? '' : metres(r.hyperfocal_m),
      'Set to': r.ev100 === null ? '' : `EV100 ${r.ev100.toFixed(1)}`,
      Meter: r.meter ? `EV100 ${r.meter.ev100.toFixed(1)}, ${Number(r.meter.lux.toPrecision(3))} lx` : '',
      'Against the meter': r.meter ? scales.stops(r.meter.over) : '',
    };
    this.find('readings').replaceChildren(...Object.entries(rows).filter(([, text]) => text).map(([name, text]) => {
      const row = document.createElement('div');
      row.append(document.createElement('dt'), document.createElement('dd'));
      row.firstChild.textContent = name;
      row.lastChild.textContent = text;
      return row;
    }));
  }

  // What the user does

  listen() {
    const {find} = this;
    const on = (id, event, act) => find(id).addEventListener(event, act);
    for (const [id, dial] of Object.entries(SELECTS)) {
      on(id, 'change', () => this.turn({[dial]: find(id).value || null}));
    }
    for (const [id, dial] of [['exposure', 'exposure'], ['meter', 'meter']]) {
      on(id, 'change', () => this.turn({[dial]: find(id).value}));
    }
    on('iris-scale', 'change', () => {
      this.rings.f_stop?.forget();
      if (this.state) this.update();
    });
    for (const button of this.root.querySelectorAll('[data-toggle]')) {
      button.addEventListener('click', () => this.toggle(button.dataset.toggle, press(button, !pressed(button))));
    }
    for (const button of this.root.querySelectorAll('[data-show]')) {
      button.addEventListener('click', () => {
        this.link.send({show: {...this.state.show, [button.dataset.show]: !pressed(button)}});
      });
    }
    for (const [event, shows] of [['pointerdown', true], ['pointerup', false], ['pointerleave', false]]) {
      on('compare', event, () => this.picture.compare(shows));
    }
    on('compare', 'keydown', (event) => event.key === ' ' && this.picture.compare(true));
    on('compare', 'keyup', () => this.picture.compare(false));
    on('level', 'click', () => this.tripod.level());
    on('reset', 'click', () => {
      this.tripod.forget();
      const names = ['place.position', 'place.look_at', 'place.roll'];
      this.turn(Object.fromEntries(names.map((name) => [name, this.open.dials[name] ?? null])));
    });
    on('reload', 'click', () => this.link.send({reload: true}));
    on('lock', 'click', () => this.lock());
    on('hyperfocal', 'click', () => {
      this.turn({focus_distance: `${Number(this.state.readings.hyperfocal_m.toPrecision(5))}`});
    });
    on('play', 'click', () => this.play(press(find('play'), !pressed(find('play')))));
    on('copy', 'click', () => this.copy());
    on('spp', 'change', () => this.link.send({draw: Number(find('spp').value)}));
    for (const button of this.root.querySelectorAll('[data-save]')) {
      button.addEventListener('click', () => this.link.send({save: button.dataset.save}));
    }
    this.tripod.clicked = (event) => this.clicked(event);
    on('picture', 'pointermove', (event) => this.loupe(event));
    addEventListener('resize', () => Object.values(this.rings).forEach((ring) => ring.scale && ring.draw()));
  }

  toggle(name, on) {
    if (name === 'loupe') this.find('loupe').hidden = !on;
    else if (name === 'section') this.find('section').hidden = !on;
    else this.picture.toggle(name, on);
  }

  clicked(event) {
    if (!this.open) return;
    const pixel = this.picture.pixel(event, this.open.resolution);
    if (!this.find('section').hidden) this.link.send({section: pixel});
    else if (this.mine) this.turn({focus_at: pixel.join(',')});
  }

  /** Keeps what the meter chose, or meters again. */
  lock() {
    this.turn({exposure: pressed(this.find('lock')) ? this.automatic ?? 'auto' : 'manual'});
  }

  /** Plays the animation as fast as pictures come. */
  play(on) {
    clearInterval(this.player);
    if (!on) return;
    const {duration_s: duration} = this.open, {fps} = this.state.readings;
    let shown = -1;
    this.player = setInterval(() => {
      const turn = Number(this.find('frame').dataset.turn);
      if (turn === shown) return;   // the last step is not on the screen yet
      shown = turn;
      const next = this.state.readings.time_s + 1 / fps;
      this.turn({time: `${next > duration ? 0 : Number(next.toFixed(6))}`});
    }, 1000 / fps);
  }

  async copy() {
    const field = this.find('command');
    try {
      await navigator.clipboard.writeText(field.value);
    } catch {   // a page that is not from this machine may not use the clipboard
      field.select();
      document.execCommand('copy');
    }
    this.find('copy').textContent = 'Copied';
    setTimeout(() => (this.find('copy').textContent = 'Copy'), 1500);
  }

  loupe(event) {
    if (this.find('loupe').hidden || !this.open || !this.picture.head) return;
    const pixel = this.picture.pixel(event, this.open.resolution);
    const now = performance.now();
    if (now - (this.probed ?? 0) > PROBE_MS) {
      this.probed = now;
      this.link.send({probe: pixel});
    }
    const context = this.find('loupe').querySelector('canvas').getContext('2d');
    context.imageSmoothingEnabled = false;
    context.clearRect(0, 0, 121, 121);
    const scale = this.picture.canvas.width / this.open.resolution[0];
    context.drawImage(this.picture.canvas, Math.floor(pixel[0] * scale) - 5, Math.floor(pixel[1] * scale) - 5, 11, 11,
      0, 0, 121, 121);
    context.strokeStyle = '#e8b84a';
    context.strokeRect(54.5, 54.5, 12, 12);
  }

  loupeValue(value) {
    this.find('loupe').querySelector('p').textContent = value
      ? `${value.x}, ${value.y}\nR ${value.rgb[0].toPrecision(4)}\nG ${value.rgb[1].toPrecision(4)}\nB ${value.rgb[2].toPrecision(4)}`
      : '';
  }
}
