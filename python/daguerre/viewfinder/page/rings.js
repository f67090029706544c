// rings.js -- the rings of the camera: their list, shown values and turned dials.

import {fill, press, pressed} from './dom.js';
import {recall, remember} from './memory.js';
import {letterOf} from './mode_dial.js';
import {Ring} from './ring.js';
import * as scales from './scales.js';

const RINGS = {
  focus_distance: 'Focus', f_stop: 'Aperture', zoom: 'Zoom', shutter_time: 'Shutter', iso: 'ISO',
  exposure_compensation: 'Exposure compensation', white_balance: 'White balance', blades: 'Iris blades', time: 'Time',
};
const IRIS_SCALES = [['f3', 'f, third stops'], ['f2', 'f, half stops'], ['T3', 'T, third stops'], ['T2', 'T, half stops']];

export class Rings {
  constructor(view) {
    this.view = view;
    this.rings = {};
    for (const [name, label] of Object.entries(RINGS)) {
      const element = document.createElement('div');
      element.dataset.label = label;
      view.find('rings').append(element);
      this.rings[name] = new Ring(element, name, (texts) => view.turn(texts));
    }
    fill(this.irisScale, IRIS_SCALES);
    this.irisScale.value = recall('iris-scale', 'f3');
    this.irisScale.addEventListener('change', () => this.rescale());
    view.find('hyperfocal').addEventListener('click', () => {
      view.turn({focus_distance: `${Number(view.state.readings.hyperfocal_m.toPrecision(5))}`});
    });
    const play = view.find('play');
    play.addEventListener('click', () => this.play(press(play, !pressed(play))));
  }

  get irisScale() {
    return this.view.find('iris-scale');
  }

  rescale() {
    remember('iris-scale', this.irisScale.value);
    this.rings.f_stop.forget();
    if (this.view.state) this.update(this.view.state);
  }

  opened({duration_s: duration}) {
    this.view.find('play').hidden = !duration;
  }

  update({dials, readings}) {
    if (!readings.lens) return;
    const {rings, view} = this, {open, current} = view;
    for (const ring of Object.values(rings)) ring.holds &&= !current;
    const of = (...names) => this.ringOf(dials, ...names);
    const iris = readings.f_stop !== null;
    rings.focus_distance.show(scales.focusScale(readings.closest_m), readings.focus_m ?? Infinity, {
      ...of('focus_distance', 'focus_at', 'focus_on'), ...(iris ? {} : {off: 'everything is sharp'}),
      span: iris ? [readings.near_m, readings.far_m ?? Infinity] : null,
    });
    rings.f_stop.element.hidden = rings.blades.element.hidden = !iris;
    if (iris) this.updateIris(dials, readings);
    rings.zoom.element.hidden = !readings.zoom_range_mm;
    if (readings.zoom_range_mm) rings.zoom.show(scales.zoomScale(readings.zoom_range_mm), readings.zoom_mm, of('zoom'));
    rings.shutter_time.show(scales.shutterScale(), readings.shutter_s || 1 / 8000, {
      ...of('shutter_time', 'shutter_angle'),
      extra: `${(360 * readings.fps * readings.shutter_s).toPrecision(3)}°`,
    });
    rings.iso.show(scales.isoScale(), readings.iso, of('iso'));
    rings.exposure_compensation.show(scales.evScale(), readings.ev, of('exposure_compensation'));
    rings.white_balance.show(scales.whiteScale(), readings.white_k ?? 6500, of('white_balance'));
    rings.blades.show(scales.bladesScale(), readings.blades, of('blades'));
    rings.time.element.hidden = !open.duration_s;
    if (open.duration_s) {
      rings.time.show(scales.timeScale(open.duration_s, readings.fps), readings.time_s, of('time'));
    }
    view.find('hyperfocal').disabled = !view.mine || readings.hyperfocal_m === null;
  }

  updateIris(dials, readings) {
    const [letter, perStop] = readings.t_stop ? this.irisScale.value : ['f', this.irisScale.value[1]];
    const loss = readings.t_stop ? readings.t_stop / readings.f_stop : 1;
    const [value, widest] = letter === 'T' ? [readings.t_stop, readings.widest * loss] : [readings.f_stop, readings.widest];
    const other = letter === 'T' ? `f/${readings.f_stop.toPrecision(3)}`
      : readings.t_stop ? `T/${readings.t_stop.toPrecision(3)}` : '';
    const names = letter === 'T' ? ['t_stop', 'f_stop'] : ['f_stop', 't_stop'];
    this.rings.f_stop.show(scales.irisScale(widest, Number(perStop), letter), value, {
      ...this.ringOf(dials, ...names, 'aperture_diameter'), extra: other,
    });
  }

  /** Dials that a ring shows; the ring turns the first. */
  ringOf(dials, dial, ...others) {
    const names = [dial, ...others].sort();
    const of = (texts) => Object.fromEntries(names.map((name) => [name, texts[name] ?? null]));
    const {state: {chosen, mode}, mine, open} = this.view;
    const metered = chosen.includes(dial) ? letterOf(mode) : '';
    const off = metered ? `The meter turns it in mode ${metered}; M lets you turn it`
      : mine ? '' : 'Another page controls the camera';
    return {dial, texts: of(dials), opened: of(open.dials), off, metered};
  }

  /** Plays the animation as fast as pictures come. */
  play(on) {
    clearInterval(this.player);
    const {view} = this;
    view.holdPlay(on);   // a play is a single undo step
    if (!on) return;
    const {duration_s: duration} = view.open, {fps} = view.state.readings;
    let shown = -1;
    this.player = setInterval(() => {
      const turn = Number(view.find('frame').dataset.turn);
      if (turn === shown) return;   // the last step is not on the screen yet
      shown = turn;
      const next = view.state.readings.time_s + 1 / fps;
      view.turn({time: `${next > duration ? 0 : Number(next.toFixed(6))}`});
    }, 1000 / fps);
  }
}
