// parade.js -- RGB parade: for each column of the picture, how bright its pixels are, channel by channel.

const COLOURS = [[255, 110, 90], [110, 225, 110], [110, 160, 255]];
const COLUMNS = 84, GAP = 2, LEVELS = 80;
const PIXELS = 65536;   // as many are enough

export class Parade {
  constructor(view) {
    this.view = view;
    this.canvas = view.find('parade');
    view.root.querySelector('[data-toggle=parade]').addEventListener('click', () => this.shown());
  }

  shown() {
    const {picture} = this.view;
    this.canvas.hidden = !picture.shows.parade;
    if (this.canvas.hidden || !picture.sheet) return;
    const {data, width, height} = picture.dialled();
    draw(this.canvas, parade(data, width, height));
  }
}

/** Counts of pixels by channel, level (the brightest first) and column, relative to their mean. */
export function parade(seen, width, height) {
  const counts = COLOURS.map(() => new Float32Array(LEVELS * COLUMNS));
  const step = Math.max(1, Math.floor((width * height) / PIXELS));
  for (let i = 0; i < width * height; i += step) {
    const column = Math.floor(((i % width) * COLUMNS) / width);
    counts.forEach((one, c) => {
      const level = Math.floor((seen[4 * i + c] * LEVELS) / 256);
      one[(LEVELS - 1 - level) * COLUMNS + column] += 1;
    });
  }
  const mean = (width * height) / step / COLUMNS / LEVELS;
  return counts.map((one) => one.map((count) => count / mean));
}

function draw(canvas, counts) {
  const context = canvas.getContext('2d');
  const image = context.createImageData(canvas.width, canvas.height);
  counts.forEach((one, c) => {
    one.forEach((count, i) => {
      const x = c * (COLUMNS + GAP) + (i % COLUMNS), y = Math.floor(i / COLUMNS);
      const share = Math.min(1, 0.35 * Math.sqrt(count));
      image.data.set([...COLOURS[c].map((v) => v * share), 255], 4 * (y * canvas.width + x));
    });
  });
  context.putImageData(image, 0, 0);
}
