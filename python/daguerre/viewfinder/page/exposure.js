// exposure.js -- what sets the brightness: mode, pattern of the meter, lock.

import {showChosen} from './choices.js';
import {fill, press, pressed} from './dom.js';

const MODES = {
  light: 'Light: 1 is white', manual: 'Manual', auto: 'Auto: sets the ISO', A: 'A: sets the time', S: 'S: sets the f-stop',
  P: 'P: sets time and f-stop',
};
const METERS = {centre: 'Centre', spot: 'Spot: point in focus', matrix: 'Matrix', highlight: 'Highlights'};

export class Exposure {
  constructor(view) {
    this.view = view;
    for (const id of ['exposure', 'meter']) {
      view.find(id).addEventListener('change', () => view.turn({[id]: view.find(id).value}));
    }
    view.find('lock').addEventListener('click', () => this.lock());
  }

  opened({modes}) {
    fill(this.view.find('exposure'), modes.map((name) => [name, MODES[name]]));
  }

  /** Mode and pattern; a pattern that is not offered, such as a spot on a node, was given. */
  update({mode, pattern}) {
    const {view} = this, offered = view.open.meters;
    const patterns = offered.includes(pattern) ? offered : [...offered, pattern];
    fill(view.find('meter'), patterns.map((name) => [name, METERS[name] ?? name]));
    showChosen(view, 'exposure', mode);
    showChosen(view, 'meter', pattern);
    if (!['light', 'manual'].includes(mode)) this.automatic = mode;
    view.find('lock').disabled = !view.mine || mode === 'light';
    press(view.find('lock'), mode === 'manual');
  }

  /** Keeps what the meter chose, or meters again. */
  lock() {
    this.view.turn({exposure: pressed(this.view.find('lock')) ? this.automatic ?? 'auto' : 'manual'});
  }
}
