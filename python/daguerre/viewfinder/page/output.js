// output.js -- output: the command line of the picture, the samples to draw, saved files.

const COPIED_MS = 1500;

export class Output {
  constructor(view) {
    this.view = view;
    this.saves = [...view.root.querySelectorAll('[data-save]')];
    const {find} = view;
    find('copy').addEventListener('click', () => this.copy());
    find('to-save').addEventListener('click', () => {
      view.root.querySelector('.out').scrollIntoView({block: 'end'});
      this.saves[0].focus();
    });
    find('spp').addEventListener('change', () => view.send({draw: Number(find('spp').value)}));
    for (const button of this.saves) {
      button.addEventListener('click', () => view.send({save: button.dataset.save}));
    }
  }

  update({command, readings}) {
    const {find, root} = this.view;
    find('command').value = command;
    find('command').closest('div').hidden = root.querySelector('[for=command]').hidden = !command;
    for (const control of [...this.saves, find('spp')]) control.disabled = !this.view.mine;
    if (root.activeElement !== find('spp')) find('spp').value = readings.spp ?? '';
  }

  told({saved}) {
    if (!saved) return;
    const line = this.view.find('saved');
    line.textContent = line.title = `Saved ${saved} where Daguerre was started`;
  }

  async copy() {
    const field = this.view.find('command'), button = this.view.find('copy');
    try {
      await navigator.clipboard.writeText(field.value);
    } catch {   // a page that is not from this machine may not use the clipboard
      field.select();
      document.execCommand('copy');
    }
    button.textContent = 'Copied';
    setTimeout(() => (button.textContent = 'Copy'), COPIED_MS);
  }
}
