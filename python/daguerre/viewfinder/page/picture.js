// picture.js -- the canvas: the picture and its overlays.

import {marks} from './marks.js';

const INSIDE = 1 - 1e-9;
const COLUMNS = 2;   // of pictures side by side

export class Picture {
  constructor(canvas, over, tint) {
    this.canvas = canvas;
    this.over = over;
    this.tint = tint;
    this.context = canvas.getContext('2d', {willReadFrequently: true});
    this.head = null;
    this.sheet = null;   // shown picture: bitmap, tint, and number of pictures side by side
    this.divider = 0.5;   // share of the width on its left
    this.clean = null;   // head of the picture on the screen, if it is denoised
    this.shows = {grid: false, horizon: false, zebra: false, peaking: false};
    this.tilt = null;
    this.whole = null;   // size of the picture, px, and where the part that is drawn begins
    this.size = null;    // of that part
  }

  /** Shows a picture; resolves when it is on the screen. */
  async show(head, bytes) {
    const decode = (data) => (data?.length ? decoded(head.kind, data, head.size) : null);
    const [bitmap, tint] = await Promise.all([decode(bytes), decode(head.tint?.bytes)]);
    if (this.head && head.picture < this.head.picture) return false;   // a newer picture came first
    if (keeps(this.clean, head)) {
      this.head = head;
      return true;
    }
    this.clean = head.denoised ? head : null;
    const {panels, part, divided, main} = head;
    this.sheet = {bitmap, tint, count: panels.length || 1, part, divided, main};
    this.head = head;
    this.draw(this.sheet);
    this.overlay();
    return true;
  }

  /** Takes the size of the picture in pixels, and the edges of the part that is drawn. */
  fit([width, height], [left, top, right, bottom]) {
    this.whole = {width, height, left, top};
    this.size = [right - left, bottom - top];
  }

  /** Whether the picture on the screen is denoised. */
  get denoised() {
    return this.clean !== null;
  }

  /** Draws a picture at its size at rest; smaller pictures are interpolated, not drawn as blocks. */
  draw(sheet) {
    const {columns, rows} = cells(sheet.divided ? 1 : sheet.count);
    this.paint(this.context, sheet.bitmap, sheet, columns, rows);
    this.tint.hidden = !sheet.tint;
    if (sheet.tint) this.paint(this.tint.getContext('2d'), sheet.tint, sheet, columns, rows);
    const [across, down] = this.size ?? [sheet.part, sheet.bitmap.height];
    this.canvas.closest('.frame').style.setProperty('--ratio', (across * columns) / (down * rows));
  }

  paint(context, bitmap, {count, part, divided}, columns, rows) {
    const [width, height] = columns === 1 && this.size ? this.size : [part, bitmap.height];
    Object.assign(context.canvas, {width: width * columns, height: height * rows});
    context.imageSmoothingQuality = 'high';
    for (let i = 0; i < count; i++) {
      const x = divided ? 0 : width * (i % columns), y = divided ? 0 : height * Math.floor(i / columns);
      context.save();
      if (divided) this.clip(context, i, width, height);
      context.drawImage(bitmap, (bitmap.width / count) * i, 0, part, bitmap.height, x, y, width, height);
      context.restore();
    }
  }

  /** Clips to the left (0) or right (1) side of the divider. */
  clip(context, side, width, height) {
    const at = Math.round(width * this.divider);
    context.beginPath();
    context.rect(side ? at : 0, 0, side ? width - at : at, height);
    context.clip();
  }

  /** Pixels of the picture that the dials show, of those side by side. */
  dialled() {
    const {bitmap, count, part, main} = this.sheet, canvas = document.createElement('canvas');
    Object.assign(canvas, {width: part, height: bitmap.height});
    const context = canvas.getContext('2d', {willReadFrequently: true});
    context.drawImage(bitmap, -(bitmap.width / count) * main, 0);
    return context.getImageData(0, 0, part, bitmap.height);
  }

  /** Moves the divider to a share of the width. */
  divide(share) {
    if (share === this.divider) return;
    this.divider = share;
    if (this.head?.divided) this.compare(null);
  }

  /** Shows another sheet instead; null: its own again. */
  compare(sheet) {
    this.draw(sheet ?? this.sheet);
    this.overlay();
  }

  toggle(name, on) {
    this.shows[name] = on;
    this.overlay();
  }

  overlay() {
    const {over, canvas} = this;
    over.width = canvas.width;
    over.height = canvas.height;
    const context = over.getContext('2d');
    context.clearRect(0, 0, over.width, over.height);
    if (!over.width) return;
    if (this.shows.zebra || this.shows.peaking) this.marks(context);
    if (this.shows.grid) this.grid(context);
    if (this.shows.horizon && this.tilt) this.horizon(context);
  }

  /** Takes the camera's roll (degrees), view direction and vertical field of view (degrees). */
  lean(roll, forward, field) {
    this.tilt = {roll: (roll * Math.PI) / 180, pitch: Math.asin(Math.max(-1, Math.min(1, forward[1]))),
      field: (field * Math.PI) / 180};
    if (this.shows.horizon) this.overlay();
  }

  /** The horizon as a pinhole sees it, gold where the camera is level. */
  horizon(context) {
    const {roll, pitch, field} = this.tilt, {width, height, left, top} = this.whole;
    const scale = this.over.width / this.size[0], long = 2 * Math.max(width, height) * scale;
    const down = (Math.tan(pitch) / Math.tan(field / 2)) * (height / 2) * scale;
    context.save();
    context.translate((width / 2 - left) * scale, (height / 2 - top) * scale);
    context.rotate(roll);
    context.strokeStyle = Math.abs(roll) < 0.002 ? '#e8b84a' : 'rgba(255,255,255,.8)';
    context.lineWidth = Math.max(1, this.over.width / 480);
    context.beginPath();
    context.moveTo(-long, down);
    context.lineTo(long, down);
    context.stroke();
    context.restore();
  }

  marks(context) {
    const {width, height} = this.canvas;
    const seen = this.context.getImageData(0, 0, width, height).data;
    context.putImageData(new ImageData(marks(seen, width, height, this.shows), width, height), 0, 0);
  }

  grid(context) {
    const {width, height} = this.over;
    context.strokeStyle = 'rgba(255,255,255,.55)';
    context.lineWidth = Math.max(1, width / 960);
    context.beginPath();
    for (const t of [1 / 3, 2 / 3]) {
      context.moveTo(width * t, 0);
      context.lineTo(width * t, height);
      context.moveTo(0, height * t);
      context.lineTo(width, height * t);
    }
    context.stroke();
  }

  /** Under a pointer: pixel of the whole picture, number of the picture among several, pixel of the canvas. */
  at({clientX, clientY}) {
    const {canvas, head, whole} = this, box = canvas.getBoundingClientRect();
    const {columns, rows} = cells(head?.divided ? 1 : head?.panels.length);
    const inside = (share) => Math.min(INSIDE, Math.max(0, share));
    const x = inside((clientX - box.left) / box.width), y = inside((clientY - box.top) / box.height);
    const [across, down] = [(x * columns) % 1, (y * rows) % 1].map((share, i) => Math.floor(share * this.size[i]));
    return {
      pixel: [whole.left + across, whole.top + down],
      part: head?.divided ? Number(x >= this.divider) : Math.floor(x * columns) + columns * Math.floor(y * rows),
      spot: [Math.floor(x * canvas.width), Math.floor(y * canvas.height)],
    };
  }
}

/** Whether a denoised picture stays until the next is denoised, too: noise must not come and go. */
function keeps(clean, head) {
  return clean !== null && head.previews && !head.rests && !head.denoised && clean.turn === head.turn
    && clean.tint?.kind === head.tint?.kind && head.samples <= 2 * clean.samples;
}

/** Columns and rows of pictures beside each other. */
function cells(count) {
  const columns = Math.min(count || 1, COLUMNS);
  return {columns, rows: Math.ceil((count || 1) / columns)};
}

/** What a canvas can draw of a picture's bytes. */
export function decoded(kind, bytes, size) {
  return kind === 'rgb' ? fromRgb(bytes, size) : createImageBitmap(new Blob([bytes], {type: 'image/jpeg'}));
}

/** A canvas with the pixels of a small picture, which needs no decoding. */
function fromRgb(bytes, [width, height]) {
  const canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext('2d');
  const image = context.createImageData(width, height);
  for (let from = 0, to = 0; from < bytes.length; from += 3, to += 4) {
    image.data[to] = bytes[from];
    image.data[to + 1] = bytes[from + 1];
    image.data[to + 2] = bytes[from + 2];
    image.data[to + 3] = 255;
  }
  context.putImageData(image, 0, 0);
  return canvas;
}

export function drawHistogram(canvas, histogram) {
  const context = canvas.getContext('2d');
  const {width, height} = canvas;
  context.clearRect(0, 0, width, height);
  context.globalCompositeOperation = 'lighter';
  const top = Math.max(...histogram.flatMap((line) => line.slice(1, -1)), 1e-4);
  histogram.forEach((line, c) => {
    context.fillStyle = ['rgb(190,50,50)', 'rgb(50,160,60)', 'rgb(60,90,200)'][c];
    context.beginPath();
    context.moveTo(0, height);
    line.forEach((share, i) => {
      const x = (i * width) / (line.length - 1);
      context.lineTo(x, height - Math.min(1, Math.sqrt(share / top)) * (height - 2));
    });
    context.lineTo(width, height);
    context.fill();
  });
  context.globalCompositeOperation = 'source-over';
}
