// link.js -- the socket to the renderer: messages out, pictures in, back again after a break.

const RETRY_MS = [200, 500, 1000, 2000];
const SILENCE_MS = 25000;   // the server pings; a socket that is silent longer is dead

/** Head and bytes of a picture's message, a Uint8Array; the tint, if any, gets separate bytes. */
export function unpack(message) {
  const length = new DataView(message.buffer, message.byteOffset, 4).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(message.subarray(4, 4 + length)));
  const {tint} = head, end = message.length - (tint?.bytes ?? 0);
  if (tint) tint.bytes = message.subarray(end);
  return [head, message.subarray(4 + length, end)];
}

export class Link {
  /** handlers: told(message), picture(head, bytes), status(text). */
  constructor(handlers) {
    this.handlers = handlers;
    this.token = decodeURIComponent(location.hash.slice(1));
    this.tries = 0;
    this.open();
    // A lid that opens, a network that returns: do not wait for the next try.
    for (const name of ['online', 'focus', 'visibilitychange']) addEventListener(name, () => this.wake());
  }

  open() {
    clearTimeout(this.timer);
    const url = new URL('live', document.baseURI);
    url.protocol = url.protocol.replace('http', 'ws');
    const socket = new WebSocket(url);
    this.socket = socket;
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      socket.send(this.token);
      this.alive();
    };
    socket.onmessage = (event) => {
      if (socket !== this.socket) return;
      this.tries = 0;
      this.alive();
      if (typeof event.data === 'string') {
        const message = JSON.parse(event.data);
        if (!message.ping) this.handlers.told(message);
      } else this.handlers.picture(...unpack(new Uint8Array(event.data)));
    };
    socket.onclose = (event) => {
      if (socket === this.socket) this.lost(event);
    };
  }

  alive() {
    clearTimeout(this.silence);
    this.silence = setTimeout(() => this.socket.close(), SILENCE_MS);
  }

  lost(event) {
    clearTimeout(this.silence);
    const final = {
      4401: 'This page has the wrong token. Open the address that daguerre view prints.',
      4429: 'Too many pages watch this picture. Close one, and reload this page.',
    }[event.code];
    this.handlers.status(final ?? 'Connection lost; trying again');
    if (final) return;
    this.timer = setTimeout(() => this.open(), RETRY_MS[Math.min(this.tries++, RETRY_MS.length - 1)]);
  }

  wake() {
    if (document.visibilityState === 'visible' && this.socket.readyState === WebSocket.CLOSED) this.open();
  }

  /** Address of the photograph of a lens; a link without a server has none. */
  photograph(name) {
    return `photographs/${name}.webp`;
  }

  send(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}
