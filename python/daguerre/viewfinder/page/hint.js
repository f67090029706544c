// hint.js -- a hint over the picture on its gestures, until the first gesture.

import {recall, remember} from './memory.js';

const BY_MOUSE = 'Click to focus · drag to orbit · turn the wheel to come closer';
const BY_TOUCH = 'Tap to focus · drag to orbit · pinch to come closer';

export class Hint {
  constructor({find}) {
    this.hint = find('hint');
    this.hint.textContent = matchMedia('(pointer: coarse)').matches ? BY_TOUCH : BY_MOUSE;
    this.known = recall('hint');
    for (const name of ['pointerdown', 'wheel', 'keydown']) find('picture').addEventListener(name, () => this.end(), {passive: true});
  }

  end() {
    this.known = true;
    this.hint.hidden = true;
    remember('hint', true);
  }

  /** Only a page that may turn the dials shows the hint. */
  told({role}) {
    if (role) this.hint.hidden = this.known || role !== 'turns';
  }
}
