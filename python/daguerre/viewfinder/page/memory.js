// memory.js -- what the page itself remembers over a reload; a browser may bar it.

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
