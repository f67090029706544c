// screen.js -- the viewfinder on the full screen.

import {press} from './dom.js';

export class Screen {
  constructor({root, find}) {
    const whole = root.querySelector('.viewfinder'), button = find('full');
    button.hidden = !document.fullscreenEnabled;
    button.addEventListener('click', () => {
      if (root.fullscreenElement) document.exitFullscreen();
      else whole.requestFullscreen().catch(() => {});   // a frame may forbid it
    });
    document.addEventListener('fullscreenchange', () => press(button, root.fullscreenElement !== null));
  }
}
