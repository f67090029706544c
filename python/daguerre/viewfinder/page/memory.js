// memory.js -- values that the page keeps over a reload, in session storage; a browser may forbid it.

const PREFIX = 'daguerre-viewfinder:';

export function recall(name, otherwise = false) {
  try {
    return JSON.parse(sessionStorage.getItem(PREFIX + name)) ?? otherwise;
  } catch {
    return otherwise;
  }
}

export function remember(name, value) {
  try {
    sessionStorage.setItem(PREFIX + name, JSON.stringify(value));
  } catch {
    // nothing is remembered
  }
}
