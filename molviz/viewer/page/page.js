// The page in the browser: a viewer that asks the server it came from, and tells it that it is still open.

import { asking } from "./asking.js";
import { element } from "./elements.js";
import { Viewer } from "./viewer.js";

const root = /** @type {HTMLElement} */ (document.querySelector("#viewer"));
const life = new EventSource("alive");
life.addEventListener("error", () => {
  if (root.dataset.server === "gone") return;
  root.dataset.server = "gone";
  root.append(element("p", { class: "wrong", role: "alert" }, "The server has ended: molviz view starts it again."));
});
Viewer.open(root, asking("ask")).catch((wrong) => root.append(String(wrong)));
