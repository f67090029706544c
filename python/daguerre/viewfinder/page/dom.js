// dom.js -- small helpers for elements.

/** Options of a select: pairs of value and text. */
export function fill(select, options) {
  const chosen = select.value;
  select.replaceChildren(...options.map(([value, text]) => {
    const option = document.createElement('option');
    option.value = value;
    option.textContent = text;
    return option;
  }));
  select.value = chosen;
}

/** Sets a toggle button; returns whether it is on. */
export function press(button, on) {
  button.setAttribute('aria-pressed', on);
  return on;
}

export const pressed = (button) => button.getAttribute('aria-pressed') === 'true';

/** Shows SVG text in an image, where its styles and scripts do nothing. */
export function showSvg(image, svg) {
  URL.revokeObjectURL(image.src);
  image.src = URL.createObjectURL(new Blob([svg], {type: 'image/svg+xml'}));
}

/** Sets the tooltip of a control, with its key where it has one. */
export function title(control, text) {
  const key = control.getAttribute('aria-keyshortcuts');
  control.title = key ? `${text} (${key})` : text;
}
