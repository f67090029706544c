// tripod.js -- moves the camera: orbit, pan, dolly, roll. The world's y is up; lengths are in metres.

const sub = (a, b) => a.map((v, i) => v - b[i]);
const add = (a, b, k = 1) => a.map((v, i) => v + k * b[i]);
const length = (a) => Math.hypot(...a);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const text = (point) => point.map((v) => Number(v.toFixed(5))).join(',');
const FLATTEST = 0.02;   // radians from straight up and down, where left and right would jump
const CLICK_PX = 4;

export class Tripod {
  /** `move(dials)` is called with the camera's new place, `clicked(event)` for a click. */
  constructor(canvas, move) {
    this.move = move;
    this.clicked = () => {};
    this.position = null;
    this.holds = false;   // stays where it was moved to
    let from = null;
    const fingers = new Map();
    const spread = () => {
      const [a, b] = fingers.values();
      return Math.hypot(a.x - b.x, a.y - b.y);
    };
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, {x: event.clientX, y: event.clientY});
      if (fingers.size === 2) {
        from = null;
        this.pinch = spread();
        return;
      }
      from = {x: event.clientX, y: event.clientY, pan: event.shiftKey || event.button === 1, moved: false};
    });
    canvas.addEventListener('pointermove', (event) => {
      if (fingers.size === 2 && fingers.has(event.pointerId)) {
        fingers.set(event.pointerId, {x: event.clientX, y: event.clientY});
        this.dolly(this.pinch / Math.max(1, spread()));
        this.pinch = spread();
      }
      if (!from) return;
      const dx = event.clientX - from.x, dy = event.clientY - from.y;
      if (!from.moved && Math.hypot(dx, dy) < CLICK_PX) return;
      from.moved = true;
      from.x = event.clientX;
      from.y = event.clientY;
      if (from.pan) this.pan(dx / canvas.clientWidth, dy / canvas.clientWidth);
      else this.orbit((-dx / canvas.clientWidth) * Math.PI, (-dy / canvas.clientWidth) * Math.PI);
    });
    canvas.addEventListener('pointerup', (event) => {
      fingers.delete(event.pointerId);
      if (from && !from.moved) this.clicked(event);
      from = null;
    });
    canvas.addEventListener('pointercancel', (event) => {
      fingers.delete(event.pointerId);
      from = null;
    });
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      this.dolly(Math.exp(Math.sign(event.deltaY) * 0.05));
    }, {passive: false});
    canvas.addEventListener('keydown', (event) => this.key(event));
  }

  /** Takes the camera's place from the server, and the point that it turns about. */
  stand(place, focus, current) {
    this.holds &&= !current;
    if (!place || this.holds) return;
    const {position, forward, roll} = place;
    const far = this.position && this.target ? length(sub(this.target, this.position)) : 0;
    this.position = position;
    this.target = add(position, forward, far || focus || 2);
    this.roll = roll;
  }

  send() {
    const dials = {'place.position': text(this.position), 'place.look_at': text(this.target)};
    dials['place.roll'] = Math.abs(this.roll) > 1e-6 ? String(Number(this.roll.toFixed(3))) : null;
    this.holds = true;
    this.move(dials);
  }

  orbit(across, up) {
    if (!this.position) return;
    const arm = sub(this.position, this.target), r = length(arm);
    const around = Math.atan2(arm[0], arm[2]) + across;
    const high = Math.min(Math.PI / 2 - FLATTEST, Math.max(FLATTEST - Math.PI / 2, Math.asin(arm[1] / r) - up));
    this.position = add(this.target, [Math.sin(around) * Math.cos(high), Math.sin(high), Math.cos(around) * Math.cos(high)], r);
    this.send();
  }

  pan(dx, dy) {
    if (!this.position) return;
    const ahead = sub(this.target, this.position), r = length(ahead);
    const right = cross(ahead, [0, 1, 0]), size = length(right) || 1;
    const up = cross(right, ahead), tall = length(up) || 1;
    const step = add(right.map((v) => (-v * dx * r) / size), up.map((v) => (v * dy * r) / tall));
    this.position = add(this.position, step);
    this.target = add(this.target, step);
    this.send();
  }

  dolly(factor) {
    if (!this.position) return;
    this.position = add(this.target, sub(this.position, this.target), factor);
    this.send();
  }

  /** Takes the roll out. */
  level() {
    if (!this.position) return;
    this.roll = 0;
    this.send();
  }

  /** Forgets the point that it turns about. */
  forget() {
    this.target = null;
  }

  turnRoll(degrees) {
    this.roll = ((this.roll + degrees + 540) % 360) - 180;
    this.send();
  }

  key(event) {
    const turns = {
      ArrowLeft: () => this.orbit(-0.05, 0), ArrowRight: () => this.orbit(0.05, 0),
      ArrowUp: () => this.orbit(0, -0.05), ArrowDown: () => this.orbit(0, 0.05),
      '+': () => this.dolly(0.95), '-': () => this.dolly(1.05),
      '[': () => this.turnRoll(-1), ']': () => this.turnRoll(1),
    };
    if (!this.position || !(event.key in turns)) return;
    event.preventDefault();
    turns[event.key]();
  }
}
