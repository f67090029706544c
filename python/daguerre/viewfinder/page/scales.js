// scales.js -- scales of the rings: where a value lies on its ring, its marks, its text.
//
// A scale maps a value to a position: one step of the ring (a third of a stop, say) is a fixed
// length, as engraved on a barrel. `text` is for the command line, `label` for people.

const round = (value, digits) => Number(value.toPrecision(digits));
const FEET = 1 / 0.3048;

function nearest(values, value) {
  return values.reduce((a, b) => (Math.abs(Math.log(b / value)) < Math.abs(Math.log(a / value)) ? b : a));
}

/** A difference in stops, such as "+0.3 EV". */
export function stops(difference) {
  const shown = Number(difference.toFixed(1)) || 0;
  return `${shown > 0 ? '+' : ''}${shown.toFixed(1)} EV`;
}

/** Full, half or third stops between two values; a stop is a factor of `factor`. */
function engraved(low, high, factor, perStop, names) {
  const found = [];
  const first = Math.ceil((Math.log(low / names.base) / Math.log(factor)) * perStop - 1e-6);
  const last = Math.floor((Math.log(high / names.base) / Math.log(factor)) * perStop + 1e-6);
  for (let i = first; i <= last; i++) {
    const exact = names.base * factor ** (i / perStop);
    found.push({value: names.known ? pick(names.known, exact) : round(exact, 3), full: i % perStop === 0});
  }
  return found;
}

function pick(known, exact) {
  const near = nearest(known, exact);
  return Math.abs(Math.log(near / exact)) < 0.06 ? near : round(exact, 2);
}

// The numbers engraved on lenses and dials, which are rounded powers.
const F_NUMBERS = [
  0.7, 0.8, 0.9, 1, 1.1, 1.2, 1.4, 1.6, 1.8, 2, 2.2, 2.5, 2.8, 3.2, 3.5, 4, 4.5, 5, 5.6, 6.3, 7.1, 8, 9, 10, 11,
  13, 14, 16, 18, 20, 22, 25, 29, 32, 36, 40, 45, 51, 57, 64, 72, 81, 90,
];
const SHUTTERS = [
  8000, 6400, 5000, 4000, 3200, 2500, 2000, 1600, 1250, 1000, 800, 640, 500, 400, 320, 250, 200, 160, 125, 100, 80,
  60, 50, 40, 30, 25, 20, 15, 13, 10, 8, 6, 5, 4,
];
const ISOS = [
  25, 32, 40, 50, 64, 80, 100, 125, 160, 200, 250, 320, 400, 500, 640, 800, 1000, 1250, 1600, 2000, 2500, 3200, 4000,
  5000, 6400, 8000, 10000, 12800, 16000, 20000, 25600, 32000, 40000, 51200, 64000, 80000, 102400,
];

export function shutterLabel(seconds) {
  if (seconds === 0) return '0 s';
  if (seconds >= 0.3) return `${round(seconds, 2)} s`;
  return `1/${round(1 / seconds, seconds < 0.1 ? 4 : 2)} s`;
}

export function metres(value) {
  return value === null || value === Infinity ? '∞' : `${round(value, value < 1 ? 2 : 3)} m`;
}

export function feet(value) {
  if (value === null || value === Infinity) return '∞';
  const all = value * FEET;
  return all < 10 ? `${round(all, 2)} ft` : `${Math.round(all)} ft`;
}

/** Focus: a helicoid turns with 1/distance. */
export function focusScale(closest) {
  const near = Math.max(closest ?? 0.25, 0.01);
  const marks = [Infinity, 50, 20, 10, 5, 3, 2, 1.5, 1.2, 1, 0.85, 0.7, 0.6, 0.5, 0.4, 0.35, 0.3, 0.25, 0.2, 0.15, 0.1];
  return {
    low: 0, high: 1 / near, step: 1 / near / 300,
    position: (value) => (value === Infinity ? 0 : 1 / value),
    value: (position) => (position < 1e-6 ? Infinity : 1 / position),
    marks: marks.filter((m) => m >= near).map((m) => ({value: m, label: m === Infinity ? '∞' : `${m}`, full: true})),
    text: (value) => (value === Infinity ? 'inf' : `${round(value, 4)}`),
    label: (value) => `${metres(value)} · ${feet(value)}${closest !== null && value < near * 1.0001 ? ' · closest' : ''}`,
    reversed: true,
  };
}

function logScale(values, {text, label, mark}) {
  const logs = values.map((v) => Math.log2(v.value));
  return {
    low: 0, high: values.length - 1, step: 1,
    position: (value) => place(logs, Math.log2(value)),
    value: (position) => values[Math.min(values.length - 1, Math.max(0, Math.round(position)))].value,
    marks: values.map((v) => ({...v, label: v.full ? mark(v.value) : ''})),
    text, label,
  };
}

/** Fractional index of a value among rising or falling values. */
function place(logs, value) {
  const way = Math.sign(logs.at(-1) - logs[0]) || 1;
  for (let i = 0; i + 1 < logs.length; i++) {
    if ((value - logs[i + 1]) * way <= 0) {
      const span = logs[i + 1] - logs[i];
      return Math.min(logs.length - 1, Math.max(0, i + (value - logs[i]) / span));
    }
  }
  return logs.length - 1;
}

export function irisScale(widest, perStop, letter) {
  const found = engraved(widest, 64, Math.SQRT2, perStop, {base: 1, known: F_NUMBERS});
  if (!found.length || Math.abs(found[0].value / widest - 1) > 0.01) found.unshift({value: round(widest, 3), full: true});
  return logScale(found, {
    text: (value) => `${value}`, mark: (value) => `${value}`,
    label: (value) => `${letter}/${round(value, 3)}`,
  });
}

export function shutterScale() {
  const short = SHUTTERS.map((n) => ({value: 1 / n, text: `1/${n}`}));
  const long = [0.3, 0.4, 0.5, 0.6, 0.8, 1, 1.3, 1.6, 2, 2.5, 3.2, 4, 5, 6, 8, 10, 13, 15, 20, 25, 30]
    .map((s) => ({value: s, text: `${s}s`}));
  const all = [...short, ...long];
  const full = new Set(['1/8000', '1/4000', '1/2000', '1/1000', '1/500', '1/250', '1/125', '1/60', '1/30', '1/15',
    '1/8', '1/4', '0.5s', '1s', '2s', '4s', '8s', '15s', '30s']);
  const texts = new Map(all.map((one) => [one.value, one.text]));
  return logScale(all.map((one) => ({value: one.value, full: full.has(one.text)})), {
    text: (value) => texts.get(value) ?? `${round(value, 4)}s`,
    mark: (value) => texts.get(value).replace('s', '″'),
    label: shutterLabel,
  });
}

export function isoScale() {
  const found = ISOS.map((value, i) => ({value, full: i % 3 === 0}));
  return logScale(found, {text: (v) => `${v}`, mark: (v) => `${v}`, label: (v) => `ISO ${round(v, 4)}`});
}

export function zoomScale([low, high]) {
  const count = 60;
  const wanted = [8, 10, 12, 14, 16, 18, 20, 24, 28, 35, 40, 50, 70, 85, 100, 135, 150, 200, 250, 300, 400, 500, 600, 800];
  const at = (value) => (Math.log(value / low) / Math.log(high / low)) * count;
  return {
    low: 0, high: count, step: 0.5,
    position: at,
    value: (p) => Math.min(high, Math.max(low, round(low * (high / low) ** (p / count), 4))),
    marks: [low, ...wanted.filter((v) => v > low * 1.04 && v < high / 1.04), high]
      .map((value) => ({value, label: `${round(value, 3)}`, full: true})),
    text: (value) => `${value}`, label: (value) => `${round(value, 3)} mm`,
  };
}

export function linearScale({low, high, step, every, text, label}) {
  const marks = [];
  for (let v = Math.ceil(low / every) * every; v <= high + 1e-9; v += every) {
    marks.push({value: round(v, 6), label: label(v).replace(/ .*/, ''), full: true});
  }
  return {
    low, high, step, marks, text, label,
    position: (value) => value, value: (position) => round(Math.round(position / step) * step, 6),
  };
}

/** White balance: equal steps of the eye are equal steps of 1/kelvins. */
export function whiteScale() {
  const kelvins = [2500, 2800, 3000, 3200, 3600, 4000, 4500, 5000, 5600, 6500, 7500, 10000];
  return {
    low: 100, high: 400, step: 2,
    position: (value) => 1e6 / value,
    value: (position) => Math.round(1e6 / position / 10) * 10,
    marks: kelvins.map((value) => ({value, label: `${value}`, full: true})),
    text: (value) => `${value}`, label: (value) => `${value} K`, reversed: true,
  };
}

export function evScale() {
  return linearScale({
    low: -6, high: 6, step: 1 / 3, every: 1, text: (v) => v.toFixed(3),
    label: (v) => `${v > 0 ? '+' : ''}${Number(v.toFixed(2))} EV`,
  });
}

/** Iris blades: none (a round iris), or three and more. */
export function bladesScale() {
  const counts = [0, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];
  return {
    low: 0, high: counts.length - 1, step: 1,
    position: (value) => Math.max(0, counts.findIndex((count) => count >= value)),
    value: (position) => counts[Math.round(position)],
    marks: counts.map((value) => ({value, label: value ? `${value}` : 'round', full: true})),
    text: (value) => `${value}`, label: (value) => (value ? `${value} blades` : 'round'),
  };
}

export function timeScale(duration, fps) {
  return linearScale({
    low: 0, high: duration, step: 1 / fps, every: Math.max(0.1, Math.round(duration) / 10),
    text: (v) => `${v}`, label: (v) => `${v.toFixed(2)} s`,
  });
}
