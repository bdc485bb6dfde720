// The viewer in a notebook: questions go to the kernel, and answers come back, as messages of a widget.

import { checked } from "./asking.js";
import { Viewer } from "./viewer.js";

/** @typedef {{send: (content: unknown) => void, on: (event: string, then: Function) => void}} Model */
/** @typedef {{question: Record<string, unknown>, signal?: AbortSignal, resolve: Function, reject: Function}} Waiting */

/** Questions wait here for the kernel, which has one at a time, so that those nobody waits for are never asked. */
class Kernel {
  /** @param {Model} model */
  constructor(model) {
    this.model = model;
    /** @type {Waiting[]} */
    this.queue = [];
    /** @type {Waiting | null} */
    this.asked = null;
    model.on("msg:custom", (/** @type {any} */ head, /** @type {DataView<ArrayBuffer>[]} */ [bytes]) => {
      const body = bytes ? new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength) : new Uint8Array();
      this.answered(head, body);
    });
  }

  /**
   * @param {any} head
   * @param {Uint8Array<ArrayBuffer>} body
   */
  answered(head, body) {
    const { asked } = this;
    this.asked = null;
    try {
      asked?.resolve(checked({ head, body }));
    } catch (wrong) {
      asked?.reject(wrong);
    }
    this.next();
  }

  /** Ask the next question that somebody still waits for. */
  next() {
    this.queue = this.queue.filter(({ signal }) => !signal?.aborted);
    if (this.asked || !this.queue.length) return;
    this.asked = /** @type {Waiting} */ (this.queue.shift());
    this.model.send(this.asked.question);
  }

  /** @type {import("./asking.js").Ask} */
  ask(question, signal) {
    return new Promise((resolve, reject) => {
      signal?.addEventListener("abort", () => reject(new DOMException("a newer question", "AbortError")));
      this.queue.push({ question, signal, resolve, reject });
      this.next();
    });
  }
}

/** @param {{model: Model, el: HTMLElement}} widget */
function render({ model, el }) {
  const kernel = new Kernel(model);
  Viewer.open(el, (question, signal) => kernel.ask(question, signal)).catch((wrong) => el.append(String(wrong)));
}

export default { render };
