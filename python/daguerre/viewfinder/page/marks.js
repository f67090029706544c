// marks.js -- marks on pixels: zebra where they are white, peaking where they are sharp.
//
// Both are black beside white or yellow, so that lightness alone tells them from any picture: no eye
// needs to see colours for them.

const ZEBRA = 250;             // of 255, in any channel
const STRIPES = 160;           // stripes across the picture, black and white each
const PEAK = 60;               // second difference of luma
const YELLOW = [255, 238, 0, 255], WHITE = [255, 255, 255, 255], BLACK = [0, 0, 0, 255];

/** Pixels (RGBA) to lay over others, `width` x `height`; `shows`: whether zebra and peaking are on. */
export function marks(seen, width, height, {zebra, peaking}) {
  const out = new Uint8ClampedArray(seen.length);
  if (zebra) stripe(seen, width, height, out);
  if (peaking) outline(sharp(luma(seen), width, height), width, height, out);
  return out;
}

/** Diagonal stripes, which stand still while the picture gets more pixels. */
function stripe(seen, width, height, out) {
  const wide = Math.max(2, Math.round(width / STRIPES / 2));
  for (let y = 0, p = 0; y < height; y++) {
    for (let x = 0; x < width; x++, p += 4) {
      if (Math.max(seen[p], seen[p + 1], seen[p + 2]) < ZEBRA) continue;
      out.set(Math.floor((x + y) / wide) % 2 ? BLACK : WHITE, p);
    }
  }
}

function luma(seen) {
  const found = new Float32Array(seen.length / 4);
  for (let i = 0, p = 0; i < found.length; i++, p += 4) {
    found[i] = 0.2126 * seen[p] + 0.7152 * seen[p + 1] + 0.0722 * seen[p + 2];
  }
  return found;
}

/** Indices of pixels on edges. */
function sharp(light, width, height) {
  const found = [];
  for (let y = 1; y < height - 1; y++) {
    for (let i = y * width + 1; i < (y + 1) * width - 1; i++) {
      const around = light[i - 1] + light[i + 1] + light[i - width] + light[i + width];
      if (Math.abs(around - 4 * light[i]) > PEAK) found.push(i);
    }
  }
  return found;
}

/** Yellow pixels with a black border. */
function outline(pixels, width, height, out) {
  for (const i of pixels) {
    const x = i % width, y = Math.floor(i / width);
    for (let v = Math.max(0, y - 1); v <= Math.min(height - 1, y + 1); v++) {
      for (let u = Math.max(0, x - 1); u <= Math.min(width - 1, x + 1); u++) out.set(BLACK, 4 * (v * width + u));
    }
  }
  for (const i of pixels) out.set(YELLOW, 4 * i);
}
