// beside.js -- another lens, stop or model beside the picture, behind a divider.

import {fill} from './dom.js';
import {irisScale} from './scales.js';

const SAME = 0.2;   // stops that nobody would compare
const PICK = 'pick';   // the option that opens the lens picker
const KEYS = {ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10, Home: -100, End: 100};
const MODELS = {exact: 'Exact lens', polynomial: 'Polynomial', thin: 'Thin lens', pinhole: 'Pinhole'};

export class Beside {
  constructor(view) {
    this.view = view;
    this.select = view.find('beside');
    this.divider = view.find('divider');
    this.percent = 50;
    view.compareWith = (name) => this.show({lens: name});
    this.select.addEventListener('change', () => this.choose(this.select.value));
    this.divider.addEventListener('keydown', (event) => this.key(event));
    this.divider.addEventListener('pointerdown', (event) => this.divider.setPointerCapture(event.pointerId));
    this.divider.addEventListener('pointermove', (event) => this.drag(event));
    this.move(this.percent);
  }

  choose(value) {
    this.update(this.view.state);   // the option names the shown picture, not the requested one
    if (value === PICK) this.view.pickOther();
    else this.show(value && JSON.parse(value));
  }

  show(beside) {
    this.view.send({show: {beside: beside || null}});
  }

  // The choice

  update({show: {beside}, readings}) {
    const value = beside ? JSON.stringify(beside) : '';
    const options = [['', beside ? 'Off' : 'Beside'], ...this.options(readings)];
    if (!options.some(([other]) => other === value)) options.push([value, this.title(beside)]);
    if (String(options) !== this.filled) fill(this.select, options);   // an open list would close
    this.filled = String(options);
    this.select.value = value;
    this.select.disabled = !this.view.mine;
  }

  options({f_stop: stop, widest, models}) {
    const stops = stop ? irisScale(widest, 1, 'f').marks.map(({value}) => value) : [];
    return [[PICK, 'Another lens …'],
      ...stops.filter((other) => Math.abs(stopsOver(other, stop)) > SAME)
        .map((other) => [JSON.stringify({f_stop: `${other}`}), `f/${other}, ${apart(other, stop)}`]),
      ...(models ?? []).map((model) => [JSON.stringify({lens_model: model}), MODELS[model]])];
  }

  title({lens, f_stop: stop, lens_model: model}) {
    if (stop) return `f/${stop}`;
    return lens ? this.view.open.lenses.find(({name}) => name === lens)?.title ?? lens : MODELS[model] ?? model;
  }

  // The divider

  shown({divided, panels}) {
    this.view.find('names').classList.toggle('divided', divided);
    this.divider.hidden = !divided;
    this.names = panels;
    this.move(this.percent);
  }

  key(event) {
    if (!(event.key in KEYS)) return;
    event.preventDefault();
    this.move(this.percent + KEYS[event.key]);
  }

  drag(event) {
    if (!this.divider.hasPointerCapture(event.pointerId)) return;
    const box = this.view.picture.canvas.getBoundingClientRect();
    this.move((100 * (event.clientX - box.left)) / box.width);
  }

  move(percent) {
    this.percent = Math.min(100, Math.max(0, percent));
    const told = Math.round(this.percent);
    this.divider.style.left = `${this.percent}%`;
    this.divider.setAttribute('aria-valuenow', told);
    this.divider.setAttribute('aria-valuetext', `${told} % ${this.names?.join(', then ') ?? ''}`);
    this.view.picture.divide(this.percent / 100);
  }
}

const stopsOver = (other, stop) => 2 * Math.log2(other / stop);

/** Difference of two stops, in thirds, such as "2 stops narrower". */
function apart(other, stop) {
  const thirds = Math.round(3 * stopsOver(other, stop)), count = Number((Math.abs(thirds) / 3).toFixed(1));
  return `${count} ${count === 1 ? 'stop' : 'stops'} ${thirds > 0 ? 'narrower' : 'wider'}`;
}
