// tools.js -- the buttons under the picture: overlays, display, position of the camera.

import {press, pressed, title} from './dom.js';
import {recall, remember} from './memory.js';

const PLACE = ['place.position', 'place.look_at', 'place.roll'];

/** Tooltips of Denoise: on, off, and before anyone pressed it. */
const DENOISES = new Map([
  [true, 'All pictures are denoised; press for none'],
  [false, 'No picture is denoised; press for all'],
  [null, 'Pictures on the way are denoised if that is fast; press to denoise the one at rest, too'],
]);

export class Tools {
  constructor(view) {
    this.view = view;
    for (const button of this.all('toggle')) {
      button.addEventListener('click', () => this.toggle(button, !pressed(button)));
      if (recall(button.dataset.toggle)) this.toggle(button, true);
    }
    for (const button of this.all('show')) {
      button.addEventListener('click', () => view.send({show: {[button.dataset.show]: !pressed(button)}}));
    }
    view.find('level').addEventListener('click', () => view.tripod.level());
    view.find('reset').addEventListener('click', () => {
      view.tripod.forget();
      view.turn(Object.fromEntries(PLACE.map((name) => [name, view.open.dials[name] ?? null])));
    });
  }

  all(kind) {
    return this.view.root.querySelectorAll(`[data-${kind}]`);
  }

  /** Lays something over the picture; the page remembers it. */
  toggle(button, on) {
    press(button, on);
    remember(button.dataset.toggle, on);
    this.view.picture.toggle(button.dataset.toggle, on);
  }

  opened({denoises}) {
    this.view.root.querySelector('[data-show=denoised]').hidden = !denoises;
  }

  update({show}) {
    const {mine, find} = this.view;
    for (const button of this.all('show')) press(button, Boolean(show[button.dataset.show]));
    title(this.view.root.querySelector('[data-show=denoised]'), DENOISES.get(show.denoised));
    for (const button of [...this.all('show'), find('level'), find('reset')]) button.disabled = !mine;
  }

  shown({panels}) {
    this.view.find('names').replaceChildren(...panels.map((name) => {
      const label = document.createElement('span');
      label.textContent = name;
      return label;
    }));
  }
}
