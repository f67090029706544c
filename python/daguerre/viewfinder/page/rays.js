// rays.js -- a panel: the lens's section with the rays of the clicked point, and the point's spread.

import {showSvg} from './dom.js';
import {metres} from './scales.js';

const SIDE = 48;

export class Rays {
  constructor(view) {
    this.view = view;
    this.pixel = null;   // point of the picture
    view.find('rays').addEventListener('close', () => (this.pixel = null));
  }

  get open() {
    return this.view.panels.shown === 'rays';
  }

  clicked(pixel) {
    if (!this.open) return false;
    this.pixel = pixel;
    this.view.send({section: pixel});
    return true;
  }

  /** The rays follow the rings. */
  shown({rests, turn}) {
    if (this.open && this.pixel && rests && turn !== this.turn) this.view.send({section: this.pixel});
    if (rests) this.turn = turn;
  }

  told({section}) {
    if (section) this.show(section);
  }

  show({svg, spread, width_um: width, pixel_um: pixel, distance_m: distance, x, y}) {
    const {find} = this.view;
    showSvg(find('rays-drawing'), svg);
    const context = find('spread').getContext('2d');
    const image = context.createImageData(SIDE, SIDE);
    spread.forEach((value, i) => image.data.set([value, value, value, 255], 4 * i));
    context.putImageData(image, 0, 0);
    find('rays-text').textContent =
      `Point at ${Math.round(x)}, ${Math.round(y)}, ${metres(distance)} away. Its spread is shown ` +
      `${micrometres(width)} wide; a pixel has ${micrometres(pixel)}.`;
  }
}

function micrometres(value) {
  return value >= 1000 ? `${(value / 1000).toPrecision(3)} mm` : `${value.toPrecision(3)} µm`;
}
