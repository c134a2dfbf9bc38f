// The websocket to the server: what is done goes out as JSON, frames come in one at a time, each acknowledged when drawn.

const AGAIN_MS = 1500;

export class Link {
  /**
   * @param {string} address
   * @param {(message: any) => void} received
   * @param {(isOpen: boolean) => void} changed
   */
  constructor(address, received, changed) {
    this.address = address;
    this.received = received;
    this.changed = changed;
    this.acknowledged = 0;
    this.isClosed = false;
    this.socket = this.open();
  }

  open() {
    const socket = new WebSocket(this.address);
    socket.binaryType = "arraybuffer";
    socket.addEventListener("open", () => this.changed(true));
    socket.addEventListener("message", ({ data }) => {
      const message = typeof data === "string" ? JSON.parse(data) : unpacked(data);
      this.received(message);
      if (message.type === "frame") this.drawn(message.number);
    });
    socket.addEventListener("close", () => {
      this.changed(false);
      if (this.isClosed) return;
      setTimeout(() => {
        this.socket = this.open();
      }, AGAIN_MS);
    });
    return socket;
  }

  /**
   * The next frame may come when this one has been seen.
   *
   * @param {number} number
   */
  drawn(number) {
    const tell = () => {
      if (this.acknowledged === number) return;
      this.acknowledged = number;
      this.send("seen", { number });
    };
    requestAnimationFrame(tell);
    // pages in the background draw nothing
    setTimeout(tell, 400);
  }

  /**
   * @param {string} type
   * @param {Record<string, any>} more
   */
  send(type, more = {}) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify({ type, ...more }));
  }
}

/**
 * A message of lamella.interactive.frame: its head, with arrays.
 *
 * @param {ArrayBuffer} data
 */
function unpacked(data) {
  const length = new DataView(data).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
  const kinds = { float32: Float32Array, uint32: Uint32Array, uint8: Uint8Array };
  /** @type {Record<string, any>} */
  const arrays = {};
  for (const [name, [kind, shape, at]] of Object.entries(head.arrays)) {
    const count = shape.reduce((/** @type {number} */ a, /** @type {number} */ b) => a * b, 1);
    arrays[name] = new kinds[/** @type {keyof typeof kinds} */ (kind)](data, 4 + length + at, count);
  }
  return { ...head, arrays };
}
