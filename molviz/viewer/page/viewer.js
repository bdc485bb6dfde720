// A viewer: stage, panel, and what is saved; it asks for pictures and shows them.

import { Refusal } from "./asking.js";
import { button, download, element } from "./elements.js";
import { Gestures, MOVES } from "./gestures.js";
import { Panel } from "./panel.js";
import { rotationOf, viewText } from "./rotations.js";
import { Scene } from "./scene.js";
import { Stage } from "./stage.js";

/** @typedef {import("./asking.js").Ask} Ask */
/** @typedef {Record<string, any>} Options */

const REST = 120; // ms without a movement before the exact picture is asked for
const HELP = "Drag to turn, with Shift to roll, with Alt to move; wheel to scale; double-click to centre; click to "
  + "mark a residue. Keys: arrows turn, Shift+arrows roll, Alt+arrows move, + − scale, 0 fits, N P mark residues, "
  + "C centres, Ctrl+Z undoes.";
const TURNED = ["view", "orient", "rotate"];
const BUTTONS = [
  ["left", "◀", "Turn left"], ["right", "▶", "Turn right"], ["up", "▲", "Turn up"], ["down", "▼", "Turn down"],
  ["rollLeft", "↺", "Roll left"], ["rollRight", "↻", "Roll right"],
  ["closer", "+", "Scale up"], ["farther", "−", "Scale down"], ["fit", "Fit", "Fit to the stage"],
];

/** The viewer in an element. */
export class Viewer {
  /**
   * Ask what there is, and show it.
   * @param {HTMLElement} root
   * @param {Ask} ask
   */
  static async open(root, ask) {
    const viewer = new Viewer(root, ask, (await ask({ ask: "start" })).head);
    await viewer.reload();
    return viewer;
  }

  /**
   * @param {HTMLElement} root
   * @param {Ask} ask
   * @param {any} head the answer to "start"
   */
  constructor(root, ask, head) {
    this.root = root;
    this.ask = ask;
    this.page = Math.random().toString(36).slice(2);
    this.number = 0;
    this.input = 0;
    this.warnings = "";
    /** @type {Options} */
    this.options = head.options;
    /** @type {Options[]} */
    this.past = [];
    /** @type {Options[]} */
    this.future = [];
    this.asked = new AbortController();
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    this.timer = undefined;
    /** whether the next rest is the first of a drag: one drag is undone at once, however often it paused */
    this.isFirstRest = true;
    this.hovered = { x: 0, y: 0, isPending: false };
    this.stage = new Stage();
    this.panel = new Panel(head.panel, (name, value) => this.change({ [name]: value }));
    this.panel.show(this.options);
    this.told = element("p", { class: "told", role: "status" });
    this.wrong = element("p", { class: "wrong", role: "alert" });
    this.command = element("output", { class: "command", tabindex: 0, "aria-label": "The command that draws this" });
    this.undoing = button("Undo", () => this.undo(), { disabled: true });
    this.redoing = button("Redo", () => this.redo(), { disabled: true });
    this.marked = element("div", { class: "marked" });
    this.format = element("select", { "aria-label": "Format of the file" },
      ...head.formats.map((/** @type {string} */ name) => element("option", { value: name }, name.toUpperCase())));
    this.fill(head.inputs);
    this.gestures = this.listen();
  }

  /**
   * Put all elements in their places.
   * @param {{name: string}[]} inputs
   */
  fill(inputs) {
    const moves = BUTTONS.map(([name, sign, label]) =>
      button(sign, () => this.press(name), { "aria-label": label, title: label }));
    const centering = button("Centre", () => this.center(), { title: "Put the marked residue, or all, in the middle" });
    this.root.classList.add("molviz");
    this.root.replaceChildren(
      element("div", { class: "left" },
        this.inputs(inputs), this.stage.root,
        element("div", { class: "tools", role: "toolbar", "aria-label": "View" },
          ...moves, centering, this.undoing, this.redoing),
        this.told, this.wrong, this.marked, element("p", { class: "help" }, HELP)),
      element("div", { class: "right" }, this.saving(), this.panel.root));
  }

  listen() {
    this.root.addEventListener("keydown", (event) => this.key(event));
    return new Gestures(this.stage.root, this.stage.camera, {
      moved: (turned) => this.moved(turned),
      began: () => (this.isFirstRest = true),
      released: () => this.released(),
      hover: (x, y) => this.hover(x, y),
      click: (x, y) => this.mark(this.residueAt(x, y)),
      center: (x, y) => this.centerAt(x, y),
      command: (name) => this.keyed(name),
    });
  }

  /** @param {{name: string}[]} inputs */
  inputs(inputs) {
    if (inputs.length === 1) return element("h1", {}, inputs[0].name);
    const select = element("select", { "aria-label": "Input" },
      ...inputs.map((one, k) => element("option", { value: k }, one.name)));
    select.addEventListener("change", () => {
      this.input = Number(select.value);
      this.stage.camera.reset();
      this.stage.placement = null;
      this.mark(-1);
      this.reload();
    });
    return select;
  }

  saving() {
    const file = element("input", { type: "file", accept: ".toml", class: "hidden-file", tabindex: -1,
      "aria-hidden": "true" });
    file.addEventListener("change", () => this.loadState(file));
    return element("fieldset", { class: "saving" }, element("legend", {}, "Save"),
      element("div", { class: "tools" }, this.format,
        button("Save", () => this.guarded(() => this.save()), { class: "main" }),
        button("Copy command", () => this.guarded(() => this.copy()))),
      this.command,
      element("div", { class: "tools" },
        button("Save state", () => this.guarded(() => this.saveState())),
        button("Load state", () => file.click()), file));
  }

  // ---- options

  /**
   * Change options, in a way that can be undone; together with the change before unless it is a step of its own.
   * @param {Options} changes
   * @param {boolean} isStep
   */
  change(changes, isStep = true) {
    const names = Object.keys(changes);
    if (names.every((name) => JSON.stringify(changes[name]) === JSON.stringify(this.options[name]))) return;
    if (isStep) this.past.push(this.options);
    this.future = [];
    this.become({ ...this.options, ...changes });
  }

  /** @param {Options} options */
  become(options) {
    const before = this.options;
    this.options = options;
    this.panel.show(options);
    this.undoing.disabled = !this.past.length;
    this.redoing.disabled = !this.future.length;
    const names = Object.keys(options).filter((name) => JSON.stringify(before[name]) !== JSON.stringify(options[name]));
    const isTurnedOnly = names.every((name) => TURNED.includes(name)) && options.view && !options.rotate.length;
    if (isTurnedOnly) this.turnTo(rotationOf(options.view));
    else this.reload();
  }

  undo() {
    const before = this.past.pop();
    if (!before) return;
    this.future.push(this.options);
    this.become(before);
  }

  redo() {
    const after = this.future.pop();
    if (!after) return;
    this.past.push(this.options);
    this.become(after);
  }

  // ---- questions

  /**
   * Do something that may be refused, and say so.
   * @param {() => Promise<void>} work
   */
  async guarded(work) {
    try {
      await work();
      this.wrong.textContent = "";
    } catch (wrong) {
      if (wrong instanceof DOMException && wrong.name === "AbortError") return;
      this.wrong.textContent = wrong instanceof Refusal ? wrong.message : `The server does not answer (${wrong}).`;
      this.root.dataset.state = "wrong";
    }
  }

  /** Ask for another scene and its picture; older questions are of no interest any more. */
  async reload() {
    const number = this.newer();
    await this.guarded(async () => {
      const { signal } = this.asked;
      const question = { ask: "scene", input: this.input, options: this.options };
      const [answer] = await Promise.all([this.ask(question, signal), this.count(signal)]);
      if (number !== this.number) return;
      const scene = new Scene(answer);
      const { camera } = this.stage;
      Object.assign(camera, { rotation: scene.head.rotation.flat(), distance: scene.head.distance ?? 0 });
      if (!this.stage.placement) camera.fit = Math.min(camera.width, camera.height) / (2 * scene.reach);
      this.mark(-1);
      this.stage.take(scene);
      this.warn(scene.head.warnings);
      await this.picture(number);
    });
  }

  /** Return the number of a newer question, and abandon the one before. */
  newer() {
    clearTimeout(this.timer);
    this.timer = undefined;
    this.asked.abort();
    this.asked = new AbortController();
    this.root.dataset.state = "moving";
    return ++this.number;
  }

  /** @param {AbortSignal} signal */
  async count(signal) {
    if (!this.options.select) {
      this.panel.note("select", "");
      return;
    }
    const { input, options } = this;
    try {
      const { head } = await this.ask({ ask: "count", input, options, select: options.select }, signal);
      this.panel.note("select", `${head.count} of ${head.of} atoms`);
    } catch (wrong) {
      this.panel.note("select", wrong instanceof Refusal ? wrong.message : "");
    }
  }

  /**
   * Ask for the exact picture, and show it unless something moved meanwhile.
   * @param {number} number
   */
  async picture(number) {
    const isWanted = () => number === this.number;
    const { input, options, page } = this;
    const { signal } = this.asked;
    this.root.dataset.state = "waiting";
    const { head, body } = await this.ask({ ask: "picture", input, options, page, number }, signal);
    if (!isWanted() || head.abandoned) return;
    const { scene, camera } = this.stage;
    if (scene && head.colors === 4 * scene.head.atoms) {
      scene.paint(body.subarray(0, head.colors));
      this.stage.recolored();
    }
    await this.stage.show(head, body.subarray(head.colors), isWanted);
    if (!isWanted()) return;
    camera.rotation = head.rotation.flat();
    this.command.textContent = head.command;
    this.told.textContent = `${head.atoms} atoms, ${head.visible} visible, ${head.arcs} arcs. ${this.warnings}`;
    this.stage.image.alt = `Drawing of ${head.atoms} atoms`;
    this.root.dataset.state = "exact";
    this.root.dataset.number = String(number);
  }

  /** @param {string[]} warnings */
  warn(warnings) {
    this.warnings = warnings.join(" ");
  }

  async save() {
    const { head, body } = await this.ask({ ask: "save", input: this.input, options: this.options,
      format: this.format.value });
    this.command.textContent = head.command;
    download(head.name, body);
  }

  async copy() {
    const text = this.command.textContent ?? "";
    try {
      await navigator.clipboard.writeText(text);
    } catch {
      getSelection()?.selectAllChildren(this.command);
      throw new Refusal("The browser lets nothing be copied: the command is selected instead.");
    }
  }

  async saveState() {
    const { head, body } = await this.ask({ ask: "state", input: this.input, options: this.options });
    download(head.name, body);
  }

  /** @param {HTMLInputElement} file */
  loadState(file) {
    return this.guarded(async () => {
      const text = await file.files?.[0]?.text();
      file.value = "";
      const { head } = await this.ask({ ask: "load", input: this.input, text });
      this.change(head.options);
    });
  }

  // ---- movements

  /** @param {boolean} turned */
  moved(turned) {
    this.stage.moved(turned);
    if (!turned) return;
    this.newer();
    this.timer = setTimeout(() => this.rest(), REST);
  }

  /** Rest at once, if the pointer has turned anything since the last rest. */
  released() {
    if (this.timer !== undefined) this.rest();
    this.isFirstRest = true;
  }

  /** The view becomes an option, and the picture is asked for. */
  rest() {
    clearTimeout(this.timer);
    this.timer = undefined;
    const view = viewText(this.stage.camera.rotation);
    if (view === this.options.view) this.turnTo(rotationOf(view));
    else this.change({ view, rotate: [], orient: "principal" }, this.isFirstRest);
    this.isFirstRest = !this.gestures.pointers.size;
  }

  /** @param {number[]} rotation */
  turnTo(rotation) {
    this.stage.camera.rotation = rotation;
    this.stage.moved(true);
    const number = this.newer();
    return this.guarded(() => this.picture(number));
  }

  /** @param {string} name of a movement */
  press(name) {
    this.moved(Boolean(MOVES[name](this.stage.camera)));
    if (name === "fit") this.stage.refit();
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    if (!(event.ctrlKey || event.metaKey) || event.target instanceof HTMLTextAreaElement
      || (event.target instanceof HTMLInputElement && event.target.type === "text")) return;
    const key = event.key.toLowerCase();
    if (key === "z" && !event.shiftKey) this.undo();
    else if (key === "y" || key === "z") this.redo();
    else return;
    event.preventDefault();
  }

  /** @param {string} name of a key's command */
  keyed(name) {
    const count = this.stage.scene?.head.residues.length ?? 0;
    const { marked } = this.stage;
    if (name === "center") this.center();
    else if (name === "none") this.mark(-1);
    else if (count) this.mark(name === "next" ? (marked + 1) % count : (Math.max(marked, 0) + count - 1) % count);
  }

  // ---- atoms and residues

  /**
   * @param {number} x
   * @param {number} y
   */
  residueAt(x, y) {
    const { scene, camera } = this.stage;
    const atom = scene ? scene.atomAt(camera, x, y) : -1;
    return scene && atom >= 0 ? scene.residue[atom] : -1;
  }

  /**
   * Name the atom under the pointer, once a frame.
   * @param {number} x
   * @param {number} y
   */
  hover(x, y) {
    const { hovered, stage } = this;
    Object.assign(hovered, { x, y });
    if (hovered.isPending) return;
    hovered.isPending = true;
    requestAnimationFrame(() => {
      hovered.isPending = false;
      const atom = stage.scene?.atomAt(stage.camera, hovered.x, hovered.y) ?? -1;
      stage.caption.textContent = atom >= 0 && stage.scene ? stage.scene.called(atom) : "";
    });
  }

  /**
   * Mark a residue, −1 for none, and offer what can be done with it.
   * @param {number} residue
   */
  mark(residue) {
    const { scene } = this.stage;
    this.stage.marked = residue;
    this.stage.moved(false);
    this.marked.replaceChildren();
    if (residue < 0 || !scene) return;
    const selection = scene.head.selections[residue];
    const color = element("input", { type: "color", value: "#dc143c", "aria-label": "Colour of the residue" });
    const paint = () => this.change({ color: [...this.options.color, `${selection}=${color.value}`] });
    color.addEventListener("change", paint);
    const able = { disabled: !selection };
    this.marked.append(
      element("strong", { role: "status" }, scene.head.residues[residue] || "all atoms"),
      element("label", {}, "Colour ", color),
      button("Label", () => this.change({ label: [...this.options.label, selection] }), able),
      button("Only this", () => this.change({ select: selection }), able));
    color.disabled = !selection;
  }

  /** Put the marked residue, or everything, in the middle. */
  center() {
    const { scene, camera, marked } = this.stage;
    if (!scene) return;
    const rows = [...scene.residue.keys()].filter((k) => scene.residue[k] === marked);
    const sum = rows.map((k) => scene.center(k)).reduce((a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]], [0, 0, 0]);
    camera.pivot = rows.length ? [sum[0] / rows.length, sum[1] / rows.length, sum[2] / rows.length] : [0, 0, 0];
    this.stage.moved(false);
  }

  /**
   * Put the atom under the pointer in the middle.
   * @param {number} x
   * @param {number} y
   */
  centerAt(x, y) {
    const { scene, camera } = this.stage;
    const atom = scene?.atomAt(camera, x, y) ?? -1;
    if (scene && atom >= 0) camera.pivot = scene.center(atom);
    else camera.pan(camera.width / 2 - x, camera.height / 2 - y);
    this.stage.moved(false);
  }
}
