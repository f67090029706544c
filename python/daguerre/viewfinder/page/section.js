// section.js -- the lens's section with the rays of the clicked point, and the point's spread.

import {showSvg} from './dom.js';
import {metres} from './scales.js';

const SIDE = 48;

export function showSection(find, {svg, spread, width_um: width, pixel_um: pixel, distance_m: distance, x, y}) {
  showSvg(find('section-drawing'), svg);
  const context = find('spread').getContext('2d');
  const image = context.createImageData(SIDE, SIDE);
  spread.forEach((value, i) => image.data.set([value, value, value, 255], 4 * i));
  context.putImageData(image, 0, 0);
  find('section').querySelector('figcaption').textContent =
    `Point at ${Math.round(x)}, ${Math.round(y)}, ${metres(distance)} away. Its spread is shown ` +
    `${micrometres(width)} wide; a pixel has ${micrometres(pixel)}.`;
}

function micrometres(value) {
  return value >= 1000 ? `${(value / 1000).toPrecision(3)} mm` : `${value.toPrecision(3)} µm`;
}
