// The stage: frames while things move, the exact picture when they rest, and what is marked on top.

import { Camera } from "./camera.js";
import { DiscRenderer } from "./discs.js";
import { element } from "./elements.js";
import { SphereRenderer } from "./spheres.js";

/** @typedef {import("./scene.js").Scene} Scene */

const SHARPNESS = [1, 0.75, 0.5, 0.35]; // pixels of the canvas to one of the page
const SLOW = 42; // ms a frame: from there on a coarser one is drawn
const FAST = 18; // ms a frame: finer ones may be tried again
const STEADY = 4; // frames between two changes
const PADDING = 12; // pixels around a drawing that fits

/** Shows a scene from a camera. */
export class Stage {
  constructor() {
    this.camera = new Camera();
    this.canvas = element("canvas", { "aria-hidden": "true" });
    this.image = element("img", { alt: "", draggable: "false", hidden: true });
    this.marks = element("canvas", { class: "marks", "aria-hidden": "true" });
    this.caption = element("span", { class: "caption", "aria-hidden": "true" });
    this.root = element("div", { class: "stage", tabindex: 0, role: "application", "aria-label": "molecule" },
      this.canvas, this.image, this.marks, this.caption);
    this.renderer = SphereRenderer.on(this.canvas) ?? new DiscRenderer(this.canvas);
    /** @type {Scene | null} */
    this.scene = null;
    /** @type {any} */
    this.placement = null;
    this.marked = -1;
    this.frames = 0;
    this.level = 0;
    this.waits = 0;
    this.pending = 0;
    this.last = 0;
    this.isExact = false;
    new ResizeObserver(() => this.measure()).observe(this.root);
  }

  /**
   * Take a scene; its picture is yet to come.
   * @param {Scene} scene
   */
  take(scene) {
    this.scene = scene;
    this.renderer.take(scene);
    this.moved(true);
  }

  /** Take new colours of the scene. */
  recolored() {
    if (this.scene) this.renderer.take(this.scene);
  }

  measure() {
    const { width, height } = this.root.getBoundingClientRect();
    if (!width || !height) return;
    Object.assign(this.camera, { width, height });
    if (this.placement) this.refit();
    this.moved(false);
  }

  /** Pixels per Å with which the picture's page, the molecule's centre in the middle, fills the stage. */
  get filling() {
    const { width, height, scale, shift } = this.placement;
    const across = Math.max(shift[0], width - shift[0]) / scale;
    const up = Math.max(shift[1], height - shift[1]) / scale;
    const room = [this.camera.width / 2 - PADDING, this.camera.height / 2 - PADDING];
    return Math.max(Math.min(room[0] / across, room[1] / up), 1e-6);
  }

  /** Let the picture's page fill the stage at zoom 1. */
  refit() {
    this.camera.fit = this.filling;
  }

  /**
   * Draw again, soon; turned: what was exact is not so any more.
   * @param {boolean} turned
   */
  moved(turned) {
    if (turned) this.isExact = false;
    if (!this.pending) this.pending = requestAnimationFrame((now) => this.frame(now));
  }

  /** @param {number} now in ms */
  frame(now) {
    this.pending = 0;
    this.image.hidden = !this.isExact;
    this.canvas.hidden = this.isExact;
    if (this.isExact) this.placeImage();
    else this.drawFrame(now);
    this.drawMarks();
  }

  /** @param {number} now in ms */
  drawFrame(now) {
    this.renderer.draw(this.camera, SHARPNESS[this.level] * Math.min(window.devicePixelRatio, 2));
    this.frames++;
    this.root.dataset.frames = String(this.frames);
    const took = now - this.last;
    this.last = now;
    this.waits++;
    if (took > 500 || this.waits < STEADY) return;
    const change = took > SLOW ? 1 : took < FAST ? -1 : 0;
    const level = Math.min(Math.max(this.level + change, 0), SHARPNESS.length - 1);
    if (level !== this.level) [this.level, this.waits] = [level, 0];
  }

  /** The page's origin is its lower left corner, and the drawing's ``shift`` points away from it. */
  placeImage() {
    const { width, height, scale, shift } = this.placement;
    const [x, y] = this.camera.place([0, 0]);
    const pixels = this.camera.scale / scale;
    Object.assign(this.image.style, {
      left: `${x - shift[0] * pixels}px`, top: `${y + (shift[1] - height) * pixels}px`,
      width: `${width * pixels}px`, height: `${height * pixels}px`,
    });
  }

  /** Rings around the atoms of the marked residue. */
  drawMarks() {
    const { marks, camera, scene } = this;
    const sharp = window.devicePixelRatio;
    marks.hidden = !scene || this.marked < 0;
    if (!scene || marks.hidden) return;
    Object.assign(marks, { width: camera.width * sharp, height: camera.height * sharp });
    const context = /** @type {CanvasRenderingContext2D} */ (marks.getContext("2d"));
    context.scale(sharp, sharp);
    const around = new Path2D();
    for (const [x, y, radius] of scene.discsOf(camera, this.marked)) {
      around.moveTo(x + radius, y);
      around.arc(x, y, radius, 0, 2 * Math.PI);
    }
    for (const [color, width] of /** @type {[string, number][]} */ ([["#fff", 9], ["#0b5fff", 5]])) {
      Object.assign(context, { strokeStyle: color, lineWidth: width });
      context.stroke(around);
    }
    context.globalCompositeOperation = "destination-out";
    context.fill(around);
    context.globalCompositeOperation = "source-over";
    context.fillStyle = "rgb(11 95 255 / 28%)";
    context.fill(around);
  }

  /**
   * Show an exact picture.
   * @param {any} placement
   * @param {Uint8Array<ArrayBuffer>} svg
   * @param {() => boolean} isWanted still, when the browser is ready to show it
   */
  async show(placement, svg, isWanted) {
    const address = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
    const before = this.image.src;
    const image = new Image();
    image.src = address;
    await image.decode().catch(() => undefined);
    if (!isWanted()) {
      URL.revokeObjectURL(address);
      return;
    }
    const isFirst = !this.placement;
    this.placement = placement;
    if (isFirst || (this.camera.zoom === 1 && this.filling < this.camera.fit)) this.refit();
    this.image.src = address;
    if (before) URL.revokeObjectURL(before);
    this.isExact = true;
    this.moved(false);
  }
}
