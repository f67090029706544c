// focus.js -- a click on the picture focuses there, and a frame shows where.

export class Focus {
  constructor(view) {
    this.view = view;
    this.mark = view.find('focus-mark');
    this.mark.addEventListener('animationend', () => (this.mark.hidden = true));
  }

  clicked(pixel, {clientX, clientY}) {
    const {view, mark} = this;
    if (!view.mine) return false;
    const {left, top, width, height} = view.picture.canvas.getBoundingClientRect();
    mark.style.left = `${(100 * (clientX - left)) / width}%`;
    mark.style.top = `${(100 * (clientY - top)) / height}%`;
    mark.hidden = true;
    mark.getBoundingClientRect();   // begins its animation anew
    mark.hidden = false;
    view.turn({focus_at: pixel.join(',')});
    return true;
  }
}
