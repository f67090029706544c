// numbers.js -- the histogram, and the numbers of the camera.

import {drawHistogram} from './picture.js';
import {feet, metres, stops} from './scales.js';

export class Numbers {
  constructor({find}) {
    this.find = find;
  }

  shown({histogram}) {
    drawHistogram(this.find('histogram'), histogram);
  }

  update({readings}) {
    if (!readings.lens) return;
    const rows = Object.entries(rowsOf(readings)).filter(([, text]) => text);
    this.find('readings').replaceChildren(...rows.map(([name, text]) => {
      const row = document.createElement('div');
      row.append(document.createElement('dt'), document.createElement('dd'));
      row.firstChild.textContent = name;
      row.lastChild.textContent = text;
      return row;
    }));
  }
}

function rowsOf(r) {
  return {
    'Focal length': `${r.focal_length_mm.toPrecision(3)} mm`,
    'Field of view': `${r.field_of_view_deg[0].toFixed(1)}° × ${r.field_of_view_deg[1].toFixed(1)}°`,
    Focus: r.f_stop === null ? 'everything is sharp' : `${metres(r.focus_m)} (${feet(r.focus_m)})`,
    'Depth of field': r.near_m === null ? '' : `${metres(r.near_m)} to ${metres(r.far_m)}`,
    Hyperfocal: r.hyperfocal_m === null ? '' : metres(r.hyperfocal_m),
    'Set to': r.ev100 === null ? '' : `EV100 ${r.ev100.toFixed(1)}`,
    Meter: r.meter ? `EV100 ${r.meter.ev100.toFixed(1)}, ${Number(r.meter.lux.toPrecision(3))} lx` : '',
    'Against the meter': r.meter ? stops(r.meter.over) : '',
  };
}
