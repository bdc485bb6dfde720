// Pointer, wheel, fingers and keys become movements of the camera.

/** @typedef {import("./camera.js").Camera} Camera */
/**
 * @typedef {object} Heard
 * @property {(turned: boolean) => void} moved after the camera has moved; turned: whether the picture changes with it
 * @property {() => void} began before a drag
 * @property {() => void} released after it
 * @property {(x: number, y: number) => void} hover
 * @property {(x: number, y: number) => void} click
 * @property {(x: number, y: number) => void} center
 * @property {(name: string) => void} command of the keyboard that is none of the camera's
 */

const CLICK = 4; // pixels that a click may move
const STEP = (5 * Math.PI) / 180; // of a key
const CLOSER = 1.15; // by a key or button
const WHEEL = 0.0015; // to the pixel of the wheel
const LINE = 16; // pixels of a wheel that counts lines
const NUDGE = 24; // pixels

/** @type {Record<string, (camera: Camera) => boolean | void>} what moves the camera; true: it was turned */
export const MOVES = {
  left: (camera) => turned(camera, "y", -STEP),
  right: (camera) => turned(camera, "y", STEP),
  up: (camera) => turned(camera, "x", -STEP),
  down: (camera) => turned(camera, "x", STEP),
  rollLeft: (camera) => turned(camera, "z", STEP),
  rollRight: (camera) => turned(camera, "z", -STEP),
  closer: (camera) => camera.magnify(CLOSER),
  farther: (camera) => camera.magnify(1 / CLOSER),
  nudgeLeft: (camera) => camera.pan(-NUDGE, 0),
  nudgeRight: (camera) => camera.pan(NUDGE, 0),
  nudgeUp: (camera) => camera.pan(0, -NUDGE),
  nudgeDown: (camera) => camera.pan(0, NUDGE),
  fit: (camera) => camera.reset(),
};

/** @type {Record<string, string>} keys, with "shift " and "alt " before them */
const KEYS = {
  ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up", ArrowDown: "down",
  "shift ArrowLeft": "rollLeft", "shift ArrowRight": "rollRight",
  "alt ArrowLeft": "nudgeLeft", "alt ArrowRight": "nudgeRight", "alt ArrowUp": "nudgeUp", "alt ArrowDown": "nudgeDown",
  "+": "closer", "shift +": "closer", "=": "closer", "-": "farther", "0": "fit", Home: "fit",
  c: "center", n: "next", p: "previous", Escape: "none",
};

/**
 * @param {Camera} camera
 * @param {"x" | "y" | "z"} axis
 * @param {number} angle
 */
function turned(camera, axis, angle) {
  camera.turn(axis, angle);
  return true;
}

/** Listens to a stage. */
export class Gestures {
  /**
   * @param {HTMLElement} stage
   * @param {Camera} camera
   * @param {Heard} heard
   */
  constructor(stage, camera, heard) {
    this.stage = stage;
    this.camera = camera;
    this.heard = heard;
    /** @type {Map<number, {x: number, y: number}>} */
    this.pointers = new Map();
    this.travelled = 0;
    stage.addEventListener("pointerdown", (event) => this.down(event));
    stage.addEventListener("pointermove", (event) => this.move(event));
    stage.addEventListener("pointerup", (event) => this.up(event, true));
    stage.addEventListener("pointercancel", (event) => this.up(event, false));
    stage.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    stage.addEventListener("keydown", (event) => this.key(event));
    stage.addEventListener("contextmenu", (event) => event.preventDefault());
    stage.addEventListener("dblclick", (event) => this.heard.center(...this.place(event)));
  }

  /**
   * Return where an event is on the stage, in pixels.
   * @param {MouseEvent} event
   * @returns {[number, number]}
   */
  place(event) {
    const box = this.stage.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  /** @param {PointerEvent} event */
  down(event) {
    const [x, y] = this.place(event);
    this.stage.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, { x, y });
    this.travelled = this.pointers.size > 1 ? Infinity : 0;
    if (this.pointers.size === 1) this.heard.began();
  }

  /** @param {PointerEvent} event */
  move(event) {
    const [x, y] = this.place(event);
    const before = this.pointers.get(event.pointerId);
    if (!before) {
      this.heard.hover(x, y);
      return;
    }
    this.travelled += Math.hypot(x - before.x, y - before.y);
    if (this.travelled < CLICK) return;
    const isTurned = this.pointers.size > 1 ? this.fingers(event.pointerId, x, y) : this.drag(event, before, x, y);
    this.pointers.set(event.pointerId, { x, y });
    this.heard.moved(isTurned);
  }

  /**
   * One pointer: turn, with shift roll, with another button or a key pan.
   * @param {PointerEvent} event
   * @param {{x: number, y: number}} before
   * @param {number} x
   * @param {number} y
   */
  drag(event, before, x, y) {
    const { camera } = this;
    if (event.buttons & 6 || event.ctrlKey || event.altKey) {
      camera.pan(x - before.x, y - before.y);
      return false;
    }
    if (event.shiftKey) {
      const angle = (/** @type {number} */ px, /** @type {number} */ py) =>
        Math.atan2(camera.height / 2 - py, px - camera.width / 2);
      camera.turn("z", angle(x, y) - angle(before.x, before.y));
      return true;
    }
    const halfTurn = Math.PI / Math.min(camera.width, camera.height);
    camera.turn("y", (x - before.x) * halfTurn);
    camera.turn("x", (y - before.y) * halfTurn);
    return true;
  }

  /**
   * Two fingers: what lies under them stays there, larger, rolled and moved.
   * @param {number} id of the finger that moves
   * @param {number} x
   * @param {number} y
   */
  fingers(id, x, y) {
    const before = /** @type {{x: number, y: number}} */ (this.pointers.get(id));
    const other = [...this.pointers].find(([key]) => key !== id)?.[1] ?? before;
    const [from, to] = [[before.x - other.x, before.y - other.y], [x - other.x, y - other.y]];
    this.camera.magnify(Math.max(Math.hypot(...to), 1) / Math.max(Math.hypot(...from), 1));
    const angle = Math.atan2(from[1], from[0]) - Math.atan2(to[1], to[0]);
    this.camera.turn("z", angle);
    this.camera.pan((x - before.x) / 2, (y - before.y) / 2);
    return angle !== 0;
  }

  /**
   * @param {PointerEvent} event
   * @param {boolean} done
   */
  up(event, done) {
    if (!this.pointers.delete(event.pointerId) || !done) return;
    if (this.travelled < CLICK) this.heard.click(...this.place(event));
    else if (!this.pointers.size) this.heard.released();
  }

  /** @param {WheelEvent} event */
  wheel(event) {
    event.preventDefault();
    this.camera.magnify(Math.exp(-event.deltaY * (event.deltaMode ? LINE : 1) * WHEEL));
    this.heard.moved(false);
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    if (event.ctrlKey || event.metaKey) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const name = KEYS[`${event.altKey ? "alt " : ""}${event.shiftKey ? "shift " : ""}${key}`];
    if (!name) return;
    event.preventDefault();
    if (name in MOVES) this.heard.moved(Boolean(MOVES[name](this.camera)));
    else this.heard.command(name);
  }
}
