// What is drawn, as columns: balls, their colours, and what each atom is called.

import { moved } from "./rotations.js";

/** @typedef {import("./camera.js").Camera} Camera */
/** @typedef {import("./rotations.js").Vector} Vector */
/** @typedef {{head: any, body: Uint8Array<ArrayBuffer>}} Answer */

/** Spheres around their common centre, row by row. */
export class Scene {
  /** @param {Answer} answer to the question "scene" */
  constructor({ head, body }) {
    const n = head.atoms;
    const b = head.balls;
    /** @type {(start: number, bytes: number) => ArrayBuffer} */
    const column = (start, bytes) => body.slice(start, start + bytes).buffer;
    /** how many balls there are: those of the atoms, then the beads of sticks */
    this.count = b;
    this.head = head;
    /** x, y, z, radius of each */
    this.balls = new Float32Array(column(0, 16 * b));
    /** the atom of each */
    this.atom = new Uint32Array(column(16 * b, 4 * b));
    this.residue = new Uint32Array(column(20 * b, 4 * n));
    this.name = new Uint32Array(column(20 * b + 4 * n, 4 * n));
    /** four bytes for each ball */
    this.colors = new Uint8Array(4 * b);
    this.paint(new Uint8Array(column(20 * b + 8 * n, 4 * n)));
    this.reach = 1e-9;
    for (let k = 0; k < b; k++) {
      this.reach = Math.max(this.reach, Math.hypot(...this.center(k)) + this.balls[4 * k + 3]);
    }
  }

  /**
   * Give the balls the colours of their atoms, four bytes each.
   * @param {Uint8Array} colors
   */
  paint(colors) {
    for (let k = 0; k < this.count; k++) {
      const row = 4 * this.atom[k];
      for (let channel = 0; channel < 4; channel++) this.colors[4 * k + channel] = colors[row + channel];
    }
  }

  /**
   * Return the centre of a ball.
   * @param {number} k
   * @returns {Vector}
   */
  center(k) {
    return [this.balls[4 * k], this.balls[4 * k + 1], this.balls[4 * k + 2]];
  }

  /**
   * Return what an atom is called.
   * @param {number} k
   */
  called(k) {
    return [this.head.residues[this.residue[k]], this.head.names[this.name[k]]].filter(Boolean).join(" ");
  }

  /**
   * Return the atom that is seen at a place of the stage, −1 for none: the ball that the ray meets first.
   * @param {Camera} camera
   * @param {number} x in pixels
   * @param {number} y
   */
  atomAt(camera, x, y) {
    const [px, py] = camera.under(x, y);
    const d = camera.distance;
    const length = d ? Math.hypot(px, py, d) : 1;
    const ray = d ? [px / length, py / length, -d / length] : [0, 0, -1];
    const [first, second, third] = [0, 3, 6].map((row) => camera.rotation.slice(row, row + 3));
    const { balls } = this;
    let [best, nearest] = [-1, Infinity];
    for (let k = 0; k < this.count; k++) {
      const a = balls[4 * k];
      const b = balls[4 * k + 1];
      const c = balls[4 * k + 2];
      const radius = balls[4 * k + 3];
      const ox = (d ? 0 : px) - (first[0] * a + first[1] * b + first[2] * c);
      const oy = (d ? 0 : py) - (second[0] * a + second[1] * b + second[2] * c);
      const oz = d - (third[0] * a + third[1] * b + third[2] * c);
      const along = ox * ray[0] + oy * ray[1] + oz * ray[2];
      const inside = along * along - ox * ox - oy * oy - oz * oz + radius * radius;
      if (inside >= 0 && -along - Math.sqrt(inside) < nearest) {
        [best, nearest] = [k, -along - Math.sqrt(inside)];
      }
    }
    return best < 0 ? best : this.atom[best];
  }

  /**
   * Return the discs x, y, radius on the stage of a residue's atoms.
   * @param {Camera} camera
   * @param {number} residue
   */
  discsOf(camera, residue) {
    const discs = [];
    for (let k = 0; k < this.count; k++) {
      if (this.residue[this.atom[k]] !== residue) continue;
      const point = moved(camera.rotation, this.center(k));
      const near = camera.distance ? camera.distance / (camera.distance - point[2]) : 1;
      discs.push([...camera.place(camera.onPage(point)), this.balls[4 * k + 3] * near * camera.scale]);
    }
    return discs;
  }
}
