// widget.js -- the panel in a notebook's cell; messages go by the kernel's comm instead of a socket.

import {mount} from './main.js';

/** Has the face of Link. */
class KernelLink {
  constructor(model, handlers) {
    this.model = model;
    model.on('msg:custom', (content, buffers) => {
      if (content.text) handlers.told(JSON.parse(content.text));
      else if (buffers.length) this.unpack(buffers[0], handlers);
    });
    handlers.status('');
    model.send({begin: true});
  }

  unpack(view, handlers) {
    const bytes = new Uint8Array(view.buffer ?? view, view.byteOffset ?? 0, view.byteLength);
    const length = new DataView(bytes.buffer, bytes.byteOffset, 4).getUint32(0, true);
    const head = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length)));
    handlers.picture(head, bytes.subarray(4 + length));
  }

  send(message) {
    this.model.send({text: JSON.stringify(message)});
  }
}

export function render({model, el}) {
  const root = el.attachShadow({mode: 'open'});
  const style = document.createElement('style');
  style.textContent = model.get('style');
  const panel = new DOMParser().parseFromString(model.get('panel'), 'text/html').querySelector('.viewfinder');
  root.append(style, panel);
  mount(root, (handlers) => new KernelLink(model, handlers));
}
