// widget.js -- the panel in a notebook's cell; messages go by the kernel's comm instead of a socket.

import {unpack} from './link.js';
import {mount} from './main.js';

/** Has the face of Link. */
class KernelLink {
  constructor(model, handlers) {
    this.model = model;
    model.on('msg:custom', (content, buffers) => {
      if (content.text) handlers.told(JSON.parse(content.text));
      else if (buffers.length) handlers.picture(...unpack(bytesOf(buffers[0])));
    });
    handlers.status('');
    model.send({begin: true});
  }

  send(message) {
    this.model.send({text: JSON.stringify(message)});
  }
}

/** Bytes of a buffer of the kernel: an ArrayBuffer or a view of a buffer. */
function bytesOf(buffer) {
  return new Uint8Array(buffer.buffer ?? buffer, buffer.byteOffset ?? 0, buffer.byteLength);
}

export function render({model, el}) {
  const root = el.attachShadow({mode: 'open'});
  const style = document.createElement('style');
  style.textContent = model.get('style');
  const panel = new DOMParser().parseFromString(model.get('panel'), 'text/html').querySelector('.viewfinder');
  root.append(style, panel);
  mount(root, (handlers) => new KernelLink(model, handlers));
}
