// Rotations as nine numbers, row after row: the page's x, y, z in the molecule's axes; and as quaternions w, x, y, z.

/** @typedef {number[]} Matrix nine numbers, row after row */
/** @typedef {[number, number, number]} Vector */

/** How many decimals of a quaternion are kept: a thousandth of a degree is less than anyone sees. */
const DECIMALS = 5;

/**
 * Return the matrix product a b.
 * @param {Matrix} a
 * @param {Matrix} b
 * @returns {Matrix}
 */
export function product(a, b) {
  const result = [];
  for (let row = 0; row < 3; row++) {
    for (let column = 0; column < 3; column++) {
      result.push(a[3 * row] * b[column] + a[3 * row + 1] * b[3 + column] + a[3 * row + 2] * b[6 + column]);
    }
  }
  return result;
}

/**
 * Return a right-handed turn about the page's x, y or z.
 * @param {"x" | "y" | "z"} axis
 * @param {number} angle in radians
 * @returns {Matrix}
 */
export function turn(axis, angle) {
  const c = Math.cos(angle);
  const s = Math.sin(angle);
  if (axis === "x") return [1, 0, 0, 0, c, -s, 0, s, c];
  if (axis === "y") return [c, 0, s, 0, 1, 0, -s, 0, c];
  return [c, -s, 0, s, c, 0, 0, 0, 1];
}

/**
 * Return where a rotation takes a point.
 * @param {Matrix} m
 * @param {Vector} p
 * @returns {Vector}
 */
export function moved(m, [x, y, z]) {
  return [m[0] * x + m[1] * y + m[2] * z, m[3] * x + m[4] * y + m[5] * z, m[6] * x + m[7] * y + m[8] * z];
}

/**
 * Return the quaternion of a rotation as the option --view has it: with w positive, or the first that is not 0.
 * The largest of the four is found first, from 4 w² = 1 + trace and its like, so that nothing small is divided by.
 * @param {Matrix} m
 * @returns {string}
 */
export function viewText(m) {
  const squares = [m[0] + m[4] + m[8], m[0] - m[4] - m[8], m[4] - m[0] - m[8], m[8] - m[0] - m[4]];
  const most = squares.indexOf(Math.max(...squares));
  const large = Math.sqrt(1 + squares[most]) / 2;
  const [a, b, c] = [m[7] - m[5], m[2] - m[6], m[3] - m[1]].map((d) => d / (4 * large));
  const [d, e, f] = [m[1] + m[3], m[2] + m[6], m[5] + m[7]].map((s) => s / (4 * large));
  const q = [[large, a, b, c], [a, large, d, e], [b, d, large, f], [c, e, f, large]][most];
  const sign = (q.find((part) => Math.abs(part) > 1e-9) ?? 1) < 0 ? -1 : 1;
  return q.map((part) => String(Number((sign * part).toFixed(DECIMALS)) + 0)).join(",");
}

/**
 * Return the rotation that w,x,y,z mean, of whatever length.
 * @param {string} text
 * @returns {Matrix}
 */
export function rotationOf(text) {
  const parts = text.split(",").map(Number);
  const [w, x, y, z] = parts.map((part) => part / Math.hypot(...parts));
  return [
    1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
    2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
    2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y),
  ];
}
