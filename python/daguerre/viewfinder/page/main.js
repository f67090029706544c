// main.js -- the page: connects its parts with the server.
//
// Each part is one module with a class, made once and listed in `parts`. It gets the viewfinder, and may have
//   opened(found)    facts of the stage: lenses, sensors, cameras, times
//   update(state)    the dials, the readings and the right to turn have changed
//   shown(head)      a picture is on the screen
//   told(message)    any message of the server
//   clicked(pixel, event)   a click on the picture; true: this part has taken it

import {Beside} from './beside.js';
import {Choices} from './choices.js';
import {Compare} from './compare.js';
import {Exposure} from './exposure.js';
import {Focus} from './focus.js';
import {Guides} from './guides.js';
import {Hint} from './hint.js';
import {Keys} from './keys.js';
import {LensPicker} from './lens_picker.js';
import {Loupe} from './loupe.js';
import {Needle} from './needle.js';
import {Numbers} from './numbers.js';
import {Output} from './output.js';
import {Panels} from './panels.js';
import {Parade} from './parade.js';
import {Picture} from './picture.js';
import {Rays} from './rays.js';
import {Rings} from './rings.js';
import {Screen} from './screen.js';
import {Switches} from './switches.js';
import {Tints} from './tints.js';
import {Tools} from './tools.js';
import {Tripod} from './tripod.js';
import {Undo} from './undo.js';

/** Longest wait for a picture until the next turn is sent, which ends the work on it. */
const PATIENCE_MS = 1000;
/** Messages that change the picture; the server answers each. */
const CHANGES = ['turn', 'draw', 'undo', 'redo', 'reload', 'show'];

/** Runs the page in a document or shadow root; `makeLink(handlers)` connects it. */
export function mount(root, makeLink) {
  return new Viewfinder(root, makeLink);
}

class Viewfinder {
  constructor(root, makeLink) {
    this.root = root;
    this.find = (id) => root.getElementById(id);
    this.open = null;    // facts of the stage
    this.state = null;   // dials and readings
    this.mine = false;   // whether this page may turn
    this.unsent = null;   // turns to send
    this.sent = false;   // whether turns were sent and their picture has not come
    this.newest = -1;    // turn of the newest picture
    this.unheard = 0;    // changes that the server has not answered yet
    const canvas = this.find('picture');
    this.picture = new Picture(canvas, this.find('over'), this.find('tint'));
    this.tripod = new Tripod(canvas, (dials) => this.turn(dials));
    this.tripod.clicked = (event) => this.clicked(event);
    this.panels = new Panels(root);
    const parts = [
      LensPicker, Choices, Exposure, Rings, Needle, Numbers, Tools, Tints, Guides, Parade, Loupe, Rays, Output, Screen,
      Compare, Beside, Undo, Switches, Focus, Hint,
    ];
    this.parts = parts.map((Part) => new Part(this));
    this.keys = new Keys(this);
    this.link = makeLink({
      told: (message) => this.told(message),
      picture: (head, bytes) => this.shown(head, bytes),
      status: (text) => this.status(text),
    });
    this.find('reload').addEventListener('click', () => this.send({reload: true}));
  }

  /** Sends a message, after unsent turns. */
  send(message) {
    if (this.unsent && !message.got && !message.probe) this.sendTurn();
    if (CHANGES.some((name) => name in message)) this.unheard++;
    this.link.send(message);
    this.markBusy();
  }

  /**
   * Sends turns at once, and later turns when a picture of the sent turns is drawn, the newest of each dial. Each
   * turn ends the work on the previous turn, so faster turns would show no pictures while a dial moves.
   */
  turn(dials) {
    this.unsent = {...this.unsent, ...dials};
    if (!this.sent) this.sendTurn();
  }

  sendTurn() {
    clearTimeout(this.patience);
    this.sent = this.unsent !== null;
    if (!this.sent) return;
    const turn = this.unsent;
    this.unsent = null;
    this.send({turn});
    this.patience = setTimeout(() => this.sendTurn(), PATIENCE_MS);
  }

  /** Whether the readings belong to the newest turn; if not, turned dials keep their positions. */
  get current() {
    if (this.unsent !== null || this.unheard > 0) return false;
    return this.state.read === this.state.turn || this.state.error !== '';
  }

  /** Tells screen readers whether the picture still changes. */
  markBusy() {
    const frame = this.find('frame'), {turn, rests} = frame.dataset;
    frame.ariaBusy = !(this.state && this.current && Number(turn) === this.state.turn && rests === 'true');
  }

  /** Tells all parts, as far as they listen. */
  tell(event, value) {
    for (const part of this.parts) part[event]?.(value);
  }

  told(message) {
    if (message.open) this.opened(message.open);
    if ('drawn' in message) this.drawn(message.drawn);
    if (message.heard) this.unheard--;
    if (message.role) this.unheard = 0;
    const noPicture = message.role || (message.heard && message.refused) || message.state?.error;
    if (noPicture) this.sendTurn();
    if (message.role) this.mine = message.role === 'turns';
    if (message.role) this.find('watches').hidden = this.mine;
    if (message.state) this.state = message.state;
    if (message.refused) this.refused = {why: message.refused, turn: this.state?.turn};
    if (this.open && this.state && (message.state || message.refused)) this.update();
    this.markBusy();
    if (message.changed) this.offer(message.changed);
    this.tell('told', message);
  }

  /** Offers to load the scene again if files changed. */
  offer([first, ...others]) {
    const more = others.length === 1 ? ` and ${others[0]}` : ` and ${others.length} other files`;
    this.find('changed').hidden = !first;
    this.find('changed').firstElementChild.textContent =
      others.length ? `${first}${more} have changed.` : `${first} has changed.`;
  }

  /** Sends the next turn once a picture of the last is drawn, while the server develops it. */
  drawn(turn) {
    if (turn <= this.newest) return;
    this.newest = turn;
    this.sendTurn();
  }

  async shown(head, bytes) {
    this.drawn(head.turn);
    const fresh = await this.picture.show(head, bytes);
    this.send({got: head.picture});
    if (!fresh) return;
    const {part: width, size: [, height]} = head, most = this.open?.spp ?? head.samples;
    const many = head.rests ? `${head.samples} samples` : `${width} × ${height}, ${head.samples} of ${most} samples`;
    this.status(this.picture.denoised ? `${many}, denoised` : many);
    this.find('progress').value = head.rests ? 1 : head.samples / most;
    this.tell('shown', head);
    Object.assign(this.find('frame').dataset, {picture: head.picture, turn: head.turn, rests: head.rests});
    this.markBusy();
  }

  status(text) {
    this.find('status').textContent = text;
  }

  /** Shows a line below the picture; none if the text is empty. */
  say(line, text) {
    this.find(line).textContent = text;
    this.find(line).hidden = !text;
  }

  opened(found) {
    this.open = found;
    this.newest = -1;   // another server counts anew
    this.find('scene').textContent = found.scene;
    if (this.root === document) document.title = `${found.scene}: Daguerre viewfinder`;
    this.find('changed').hidden = true;
    this.picture.fit(found.resolution, found.window);
    this.tell('opened', found);
  }

  update() {
    const {readings, error, note, turn} = this.state;
    this.say('error', error || (this.refused?.turn === turn ? this.refused.why : ''));   // until the next turn
    this.say('note', [note, ...(readings.warnings ?? [])].filter(Boolean).join('; '));
    if (readings.lens) {
      this.open.spp = readings.spp;
      this.tripod.stand(readings.place, readings.focus_m, this.current);
      this.picture.lean(readings.place.roll, readings.place.forward, readings.field_of_view_deg[1]);
    }
    this.tell('update', this.state);
  }

  /** Offers a click on the picture to the parts, until a part takes it. */
  clicked(event) {
    if (!this.open) return;
    const {pixel} = this.picture.at(event);
    this.parts.some((part) => part.clicked?.(pixel, event));
  }
}
