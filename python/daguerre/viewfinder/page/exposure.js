// exposure.js -- controls of the brightness: mode, pattern of the meter, lock.

import {showChosen} from './choices.js';
import {fill, press, title} from './dom.js';
import {recall, remember} from './memory.js';
import {letterOf, ModeDial} from './mode_dial.js';

const METERS = {centre: 'Centre', spot: 'Spot: point in focus', matrix: 'Matrix', highlight: 'Highlights'};
const LOCKS = 'Keep the exposure as it is now; press again to meter';

export class Exposure {
  constructor(view) {
    this.view = view;
    this.locked = recall('locked', null);   // mode that was locked
    this.dial = new ModeDial(view.find('exposure'), (exposure) => view.turn({exposure}));
    view.find('meter').addEventListener('change', () => view.turn({meter: view.find('meter').value}));
    view.find('lock').addEventListener('click', () => this.lock());
  }

  /** Mode and pattern, also a pattern of the command line that is not offered, such as a spot on a node. */
  update({mode, pattern}) {
    const {view} = this, offered = view.open.meters;
    const patterns = offered.includes(pattern) ? offered : [...offered, pattern];
    fill(view.find('meter'), patterns.map((name) => [name, METERS[name] ?? name]));
    if (view.current || !this.dial.focused) this.dial.show(mode, view.mine);
    showChosen(view, 'meter', pattern);
    this.mode = mode;
    if (view.current && mode !== 'manual') this.remember(null);
    const button = view.find('lock'), locked = mode === 'manual' && this.locked, meters = !['light', 'manual'].includes(mode);
    press(button, Boolean(locked));
    button.disabled = !view.mine || !(locked || meters);
    title(button, locked ? `Meter again, in mode ${letterOf(locked)}` : meters ? LOCKS : `No meter sets anything in ${letterOf(mode)}`);
  }

  /** Keeps the exposure that the meter chose, or meters again. */
  lock() {
    if (this.mode === 'manual') {
      this.view.turn({exposure: this.locked});
      return;
    }
    this.remember(this.mode);
    this.view.turn({exposure: 'manual'});
  }

  remember(mode) {
    this.locked = mode;
    remember('locked', mode);
  }
}
