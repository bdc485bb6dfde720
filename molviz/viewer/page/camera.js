// Where the eye is and how large things are on the screen: from ångström to pixels.

import { moved, product, turn } from "./rotations.js";

/** @typedef {import("./rotations.js").Matrix} Matrix */
/** @typedef {import("./rotations.js").Vector} Vector */

const LEAST_ZOOM = 0.1;
const MOST_ZOOM = 60;

/** The view of a scene whose centre is the origin; the pivot is the point that stays in the middle of the stage. */
export class Camera {
  constructor() {
    /** @type {Matrix} */
    this.rotation = [1, 0, 0, 0, 1, 0, 0, 0, 1];
    /** @type {Vector} */
    this.pivot = [0, 0, 0];
    /** Å from the eye to the centre, 0 for a parallel projection */
    this.distance = 0;
    /** pixels per Å of a drawing that fits the stage */
    this.fit = 10;
    this.zoom = 1;
    this.width = 1;
    this.height = 1;
  }

  /** Pixels per Å. */
  get scale() {
    return this.fit * this.zoom;
  }

  /**
   * Turn about an axis of the page.
   * @param {"x" | "y" | "z"} axis
   * @param {number} angle in radians
   */
  turn(axis, angle) {
    this.rotation = product(turn(axis, angle), this.rotation);
  }

  /**
   * Look closer, or from farther away.
   * @param {number} factor
   */
  magnify(factor) {
    this.zoom = Math.min(Math.max(this.zoom * factor, LEAST_ZOOM), MOST_ZOOM);
  }

  /**
   * Move what is seen by pixels: the pivot moves the other way.
   * @param {number} dx
   * @param {number} dy
   */
  pan(dx, dy) {
    const inverse = [0, 3, 6, 1, 4, 7, 2, 5, 8].map((k) => this.rotation[k]);
    const [x, y, z] = moved(inverse, [-dx / this.scale, dy / this.scale, 0]);
    this.pivot = [this.pivot[0] + x, this.pivot[1] + y, this.pivot[2] + z];
  }

  /** Let the drawing fill the stage, its centre in the middle. */
  reset() {
    this.pivot = [0, 0, 0];
    this.zoom = 1;
  }

  /** Where the pivot lies on the page, in Å. */
  get middle() {
    return this.onPage(moved(this.rotation, this.pivot));
  }

  /**
   * Return where a point in view coordinates lies on the page, in Å.
   * @param {Vector} point
   * @returns {[number, number]}
   */
  onPage([x, y, z]) {
    const factor = this.distance ? this.distance / (this.distance - z) : 1;
    return [x * factor, y * factor];
  }

  /**
   * Return the point of the page, in Å, under a place on the stage, in pixels from its upper left corner.
   * @param {number} x
   * @param {number} y
   * @returns {[number, number]}
   */
  under(x, y) {
    const [a, b] = this.middle;
    return [a + (x - this.width / 2) / this.scale, b - (y - this.height / 2) / this.scale];
  }

  /**
   * Return the place on the stage, in pixels, of a point of the page in Å.
   * @param {[number, number]} point
   * @returns {[number, number]}
   */
  place([x, y]) {
    const [a, b] = this.middle;
    return [this.width / 2 + (x - a) * this.scale, this.height / 2 - (y - b) * this.scale];
  }
}
