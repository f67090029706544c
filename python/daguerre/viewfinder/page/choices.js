// choices.js -- the lists to choose from: camera, sensor, look, type of shutter.

import {fill} from './dom.js';

const SELECTS = {cameras: 'camera', sensor: 'sensor', look: 'look', 'shutter-type': 'shutter_type'};
const NONE = ['', 'as in the scene'];

export class Choices {
  constructor(view) {
    this.view = view;
    for (const [id, dial] of Object.entries(SELECTS)) {
      const select = view.find(id);
      select.addEventListener('change', () => view.turn({[dial]: select.value || null}));
    }
  }

  opened({cameras, sensors, looks, shutter_types: types}) {
    for (const [id, names] of Object.entries({cameras, sensor: sensors, look: looks, 'shutter-type': types})) {
      fill(this.view.find(id), [NONE, ...names.map((name) => [name, name])]);
    }
  }

  update({dials}) {
    for (const [id, dial] of Object.entries(SELECTS)) showChosen(this.view, id, dials[dial] ?? '');
  }
}

/** Shows a value in a select, unless the user is choosing there. */
export function showChosen(view, id, value) {
  const select = view.find(id);
  if (view.current || view.root.activeElement !== select) select.value = value;
  select.disabled = !view.mine;
}
