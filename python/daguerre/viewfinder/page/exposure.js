// exposure.js -- what sets the brightness: mode, pattern of the meter, lock.

import {showChosen} from './choices.js';
import {fill, press, pressed} from './dom.js';
import {ModeDial} from './mode_dial.js';

const METERS = {centre: 'Centre', spot: 'Spot: point in focus', matrix: 'Matrix', highlight: 'Highlights'};

export class Exposure {
  constructor(view) {
    this.view = view;
    this.dial = new ModeDial(view.find('exposure'), (exposure) => view.turn({exposure}));
    view.find('meter').addEventListener('change', () => view.turn({meter: view.find('meter').value}));
    view.find('lock').addEventListener('click', () => this.lock());
  }

  /** Mode and pattern; a pattern that is not offered, such as a spot on a node, was given. */
  update({mode, pattern}) {
    const {view} = this, offered = view.open.meters;
    const patterns = offered.includes(pattern) ? offered : [...offered, pattern];
    fill(view.find('meter'), patterns.map((name) => [name, METERS[name] ?? name]));
    if (view.current || !this.dial.focused) this.dial.show(mode, view.mine);
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
