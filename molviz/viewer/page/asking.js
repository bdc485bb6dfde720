// Questions to the server, and its answers: a head that is JSON, and bytes.

/** @typedef {import("./scene.js").Answer} Answer */
/** @typedef {(question: Record<string, unknown>, signal?: AbortSignal) => Promise<Answer>} Ask */

/** An answer that says what is wrong. */
export class Refusal extends Error {}

/**
 * Return a function that asks the server whose page this is.
 * @param {string} address
 * @returns {Ask}
 */
export function asking(address) {
  return async (question, signal) => {
    const headers = { "Content-Type": "application/json" };
    const response = await fetch(address, { method: "POST", headers, body: JSON.stringify(question), signal });
    if (!response.ok) throw new Refusal(`The server refuses this (${response.status}).`);
    return checked(unpacked(new Uint8Array(await response.arrayBuffer())));
  };
}

/**
 * Return the head and the body of what was sent.
 * @param {Uint8Array<ArrayBuffer>} bytes
 * @returns {Answer}
 */
export function unpacked(bytes) {
  const length = new DataView(bytes.buffer, bytes.byteOffset).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length)));
  return { head, body: bytes.subarray(4 + length) };
}

/**
 * Return an answer as it is; throws a Refusal where it says what is wrong.
 * @param {Answer} answer
 */
export function checked(answer) {
  if (answer.head.error) throw new Refusal(answer.head.error);
  return answer;
}
