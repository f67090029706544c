// undo.js -- undo and redo; a drag without letting go is a single step.

export class Undo {
  constructor(view) {
    this.view = view;
    this.plays = false;
    view.holdPlay = (on) => this.holdPlay(on);
    for (const name of ['undo', 'redo']) view.find(name).addEventListener('click', () => view.send({[name]: true}));
    for (const id of ['rings', 'picture']) {
      view.find(id).addEventListener('pointerdown', () => this.hold(true));
      for (const end of ['pointerup', 'pointercancel']) view.find(id).addEventListener(end, () => this.hold(false));
    }
  }

  /** Begins a gesture, or ends it after its last turn. */
  hold(begins) {
    if (!this.view.mine || this.plays) return;
    if (begins) this.view.send({hold: true});
    else requestAnimationFrame(() => this.view.send({hold: false}));
  }

  /** A play is a single gesture, also if another dial is dragged meanwhile. */
  holdPlay(on) {
    this.plays = false;
    this.hold(on);
    this.plays = on;
  }

  update({undoes, redoes}) {
    this.view.find('undo').disabled = !this.view.mine || !undoes;
    this.view.find('redo').disabled = !this.view.mine || !redoes;
  }
}
