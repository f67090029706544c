// guides.js -- the frame of another aspect, such as a film's; the picture outside is dark.

import {recall, remember} from './memory.js';

const ASPECTS = {'2.39:1': 2.39, '1.85:1': 1.85, '1:1': 1, '4:5': 4 / 5};

export class Guides {
  constructor({find}) {
    this.frame = find('guide');
    this.choice = find('guides');
    for (const name of Object.keys(ASPECTS)) this.choice.add(new Option(name, name));
    this.choice.value = recall('guides', '');
    this.choice.addEventListener('change', () => {
      remember('guides', this.choice.value);
      this.draw();
    });
  }

  shown({size: [width, height], panels}) {
    this.aspect = panels.length ? null : width / height;
    this.draw();
  }

  draw() {
    const aspect = ASPECTS[this.choice.value];
    this.frame.hidden = !aspect || !this.aspect;
    if (this.frame.hidden) return;
    const across = Math.min(1, aspect / this.aspect), down = Math.min(1, this.aspect / aspect);
    const percent = (share) => `${50 * (1 - share)}%`;
    this.frame.style.inset = `${percent(down)} ${percent(across)}`;
    this.frame.firstElementChild.textContent = this.choice.value;
  }
}
