// Spheres as discs on a plain canvas, back to front: for browsers without WebGL.

import { moved } from "./rotations.js";

/** @typedef {import("./camera.js").Camera} Camera */
/** @typedef {import("./scene.js").Scene} Scene */

const SMALL = 3; // pixels: smaller discs are squares, which are many times as fast
const RIM = "rgb(0 0 0 / 45%)";

/** Draws a scene's spheres as discs. */
export class DiscRenderer {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    /** @type {Scene | null} */
    this.scene = null;
    /** @type {string[]} */
    this.styles = [];
  }

  /**
   * Take a scene to draw.
   * @param {Scene} scene
   */
  take(scene) {
    this.scene = scene;
    this.styles = Array.from({ length: scene.count }, (_, k) =>
      `rgb(${scene.colors[4 * k]} ${scene.colors[4 * k + 1]} ${scene.colors[4 * k + 2]})`);
  }

  /**
   * Draw one frame.
   * @param {Camera} camera
   * @param {number} sharpness pixels of the canvas to one of the page
   */
  draw(camera, sharpness) {
    const { canvas, context, scene } = this;
    canvas.width = Math.max(1, Math.round(camera.width * sharpness));
    canvas.height = Math.max(1, Math.round(camera.height * sharpness));
    if (!scene) return;
    const points = Array.from({ length: scene.count }, (_, k) => moved(camera.rotation, scene.center(k)));
    const order = points.map((_, k) => k).sort((a, b) => points[a][2] - points[b][2]);
    context.scale(sharpness, sharpness);
    context.strokeStyle = RIM;
    for (const k of order) {
      const [x, y] = camera.place(camera.onPage(points[k]));
      const near = camera.distance ? camera.distance / (camera.distance - points[k][2]) : 1;
      this.disc(x, y, scene.balls[4 * k + 3] * near * camera.scale, this.styles[k]);
    }
  }

  /**
   * @param {number} x
   * @param {number} y
   * @param {number} radius
   * @param {string} style
   */
  disc(x, y, radius, style) {
    const { context } = this;
    context.fillStyle = style;
    if (radius < SMALL) {
      context.fillRect(x - radius, y - radius, 2 * radius, 2 * radius);
      return;
    }
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.fill();
    context.stroke();
  }
}
