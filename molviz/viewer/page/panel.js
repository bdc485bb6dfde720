// The panel of options, made from the table that the server sends: a new option or choice there appears by itself here.

import { element } from "./elements.js";

/** @typedef {{name: string, label: string, kind: string, usual: any, choices: string[], hint: string}} Field */
/** @typedef {{title: string, fields: Field[]}} Group */

const PAUSE = 500; // ms after the last letter before a text is used

let panels = 0; // how many there are on the page: ids are of one

/** Fields for options. */
export class Panel {
  /**
   * @param {Group[]} groups
   * @param {(name: string, value: any) => void} change
   */
  constructor(groups, change) {
    this.change = change;
    this.prefix = `molviz-${panels++}`;
    /** @type {Map<string, (value: any) => void>} what shows an option's value */
    this.shown = new Map();
    /** @type {Map<string, HTMLElement>} what stands beside a field */
    this.notes = new Map();
    this.root = element("form", { class: "panel", onsubmit: (/** @type {Event} */ event) => event.preventDefault() },
      ...groups.map((group) =>
        element("fieldset", {}, element("legend", {}, group.title), ...group.fields.map((field) => this.row(field)))));
  }

  /**
   * Show the values of all options.
   * @param {Record<string, any>} options
   */
  show(options) {
    for (const [name, show] of this.shown) show(options[name]);
  }

  /**
   * Say something beside a field.
   * @param {string} name
   * @param {string} text
   */
  note(name, text) {
    const note = this.notes.get(name);
    if (note) note.textContent = text;
  }

  /** @param {Field} field */
  row(field) {
    const id = `${this.prefix}-${field.name}`;
    const note = element("small", { id: `${id}-note`, role: "status" });
    this.notes.set(field.name, note);
    const label = element("label", { for: id }, field.label);
    const controls = this.controls(field, { id, name: field.name, "aria-describedby": `${id}-note` });
    const parts = field.kind === "flag" || field.kind === "auto" ? [...controls, label] : [label, ...controls];
    return element("div", { class: `row ${field.kind}` }, ...parts, note);
  }

  /**
   * Return the controls of a field, which tell of changes and show values.
   * @param {Field} field
   * @param {Record<string, unknown>} more attributes of the first
   * @returns {HTMLElement[]}
   */
  controls(field, more) {
    if (field.kind === "flag" || field.kind === "auto") return [this.box(field, more)];
    if (field.kind === "choice") return [this.choice(field, more)];
    return field.kind === "list" ? this.list(field, more) : [this.text(field, more)];
  }

  /**
   * @param {Field} field
   * @param {Record<string, unknown>} more
   */
  box(field, more) {
    const box = element("input", { type: "checkbox", ...more });
    const [on, off] = field.kind === "auto" ? ["auto", null] : [true, false];
    box.addEventListener("change", () => this.change(field.name, box.checked ? on : off));
    this.shown.set(field.name, (value) => (box.checked = value !== null && value !== false));
    return box;
  }

  /**
   * @param {Field} field
   * @param {Record<string, unknown>} more
   */
  choice(field, more) {
    const names = field.usual === null ? ["", ...field.choices] : field.choices;
    const options = names.map((name) => element("option", { value: name }, name || "the style's"));
    const select = element("select", more, ...options);
    select.addEventListener("change", () => this.change(field.name, select.value || null));
    this.shown.set(field.name, (value) => (select.value = value ?? ""));
    return select;
  }

  /**
   * @param {Field} field
   * @param {Record<string, unknown>} more
   */
  text(field, more) {
    const mode = field.kind === "number" ? "decimal" : "text";
    const input = element("input", { type: "text", inputmode: mode, spellcheck: "false",
      placeholder: field.hint || String(field.usual ?? ""), autocomplete: "off", ...more });
    const value = () => {
      const text = input.value.trim();
      if (!text) return field.usual;
      return field.kind === "number" && Number.isFinite(Number(text)) ? Number(text) : text;
    };
    whenWritten(input, () => this.change(field.name, value()));
    this.shown.set(field.name, (one) => {
      if (String(value() ?? "") !== String(one ?? "")) input.value = one === field.usual ? "" : String(one ?? "");
    });
    return input;
  }

  /**
   * A value on each line; where there are choices, one of them may stand for all that no line names.
   * @param {Field} field
   * @param {Record<string, unknown>} more
   */
  list(field, more) {
    const lines = element("textarea", { rows: 2, placeholder: field.hint, spellcheck: "false", ...more });
    const plain = element("select", { "aria-label": `${field.label} of everything` },
      ...["", ...field.choices].map((name) => element("option", { value: name }, name || "usual")));
    const value = () => [plain.value, ...lines.value.split("\n")].map((line) => line.trim()).filter(Boolean);
    whenWritten(lines, () => this.change(field.name, value()));
    plain.addEventListener("change", () => this.change(field.name, value()));
    this.shown.set(field.name, (given) => {
      const all = Array.isArray(given) ? given.map(String) : given ? [String(given)] : [];
      if (all.join("\n") === value().join("\n")) return;
      plain.value = all.find((one) => field.choices.includes(one)) ?? "";
      lines.value = all.filter((one) => one !== plain.value).join("\n");
    });
    return field.choices.length ? [plain, lines] : [lines];
  }
}

/**
 * Call back when a text was changed, and nothing more is typed for a while.
 * @param {HTMLInputElement | HTMLTextAreaElement} field
 * @param {() => void} then
 */
function whenWritten(field, then) {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  const now = () => {
    clearTimeout(timer);
    then();
  };
  field.addEventListener("input", () => {
    clearTimeout(timer);
    timer = setTimeout(now, PAUSE);
  });
  field.addEventListener("change", now);
}
