// mode_dial.js -- the mode dial of the camera: P, A, S, M, auto or light.

const MODES = {
  P: ['P', 'Program: the meter sets time and f-stop'],
  A: ['A', 'Aperture first: you set the f-stop, the meter the time'],
  S: ['S', 'Shutter first: you set the time, the meter the f-stop'],
  manual: ['M', 'Manual: you set f-stop, time and ISO'],
  auto: ['Auto', 'Auto ISO: you set f-stop and time, the meter the ISO'],
  light: ['Light', 'The light itself: 1 is white; f-stop and time only blur'],
};

/** Name of a mode on the dial. */
export const letterOf = (mode) => MODES[mode]?.[0] ?? mode;

export class ModeDial {
  /** `chosen(mode)` is called when the user turns the dial. */
  constructor(element, chosen) {
    this.element = element;
    this.inputs = {};
    for (const [mode, [letter, does]] of Object.entries(MODES)) {
      const label = document.createElement('label'), input = document.createElement('input');
      Object.assign(input, {type: 'radio', name: 'mode', value: mode, title: does});
      input.setAttribute('aria-label', does);
      label.append(input, letter);
      input.addEventListener('change', () => chosen(mode));
      element.append(label);
      this.inputs[mode] = input;
    }
    element.addEventListener('focus', () => this.input?.focus());   // its key goes to the dial
  }

  get input() {
    return this.element.querySelector(':checked');
  }

  /** Whether the user is turning it. */
  get focused() {
    return this.element.contains(this.element.getRootNode().activeElement);
  }

  show(mode, mine) {
    this.inputs[mode].checked = true;
    for (const input of Object.values(this.inputs)) input.disabled = !mine;
  }
}
