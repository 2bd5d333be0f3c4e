/** Opening scenes: of the gallery, and files; saving what is drawn and what was run. */

import { $, add } from "./player/dom.js";
import { fromDocument, toRequest } from "./model.js";
import { ask, receive, upload } from "./server.js";
import { text } from "./rational.js";
import { extentOfAll, lineOf } from "./shapes.js";

const [WIDE, HIGH] = [120, 76]; // of a small picture, as in the style

/** Gives a file to the browser, which saves it. */
function download(blob, name) {
  const link = add(document.body, "a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

export function files(store, { opened, trouble, runs }) {
  const { state } = store;
  const dialog = $("open-dialog");
  const gallery = ask("api/gallery");
  let file = null; // the last one that was opened

  // -- the gallery ------------------------------------------------------------------------------

  async function list() {
    const { scenes } = await gallery;
    if ($("gallery").childElementCount) return;
    for (const { name, shows, swept } of scenes) {
      const button = add(add($("gallery"), "li"), "button", { type: "button", "data-scene": name });
      const picture = add(button, "span", { class: "picture" });
      const words = add(button, "span", { class: "words" });
      add(words, "strong", {}, name);
      if (swept) add(words, "em", {}, "Seed Spreader");
      add(words, "span", {}, shows);
      button.addEventListener("click", () => openGallery(name));
      seen.observe(picture);
    }
  }

  /** Small pictures are drawn when they come into sight. */
  const seen = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      if (!isIntersecting) continue;
      seen.unobserve(target);
      ask(`api/gallery/${target.parentElement.dataset.scene}`).then(({ scene }) => sketch(target, fromDocument(scene)), () => {});
    }
  });

  async function openGallery(name) {
    try {
      const told = await ask(`api/gallery/${name}`);
      file = null;
      dialog.close();
      show(told, name);
    } catch (error) {
      $("open-trouble").textContent = error.message;
    }
  }

  // -- files ------------------------------------------------------------------------------------

  /** Fields for the options of the file's format. */
  async function offer() {
    const { formats } = await gallery;
    const suffix = suffixOf(file.name);
    const known = formats.find(({ suffixes }) => suffixes.includes(suffix));
    $("options").replaceChildren();
    $("file-name").textContent = file.name;
    $("file-part").hidden = false;
    for (const { name, kind, help, choices, default: usual } of known?.options ?? []) {
      const label = add($("options"), "label", { title: help });
      add(label, "span", {}, name);
      if (kind === "choice") {
        const select = add(label, "select", { "data-option": name });
        for (const choice of choices) add(select, "option", choice === usual ? { selected: "" } : {}, choice);
        if (usual === null) select.prepend(new Option("", "", true, true));
      } else {
        const placeholder = { names: "A,B", number: "N" }[kind] ?? "";
        add(label, "input", { type: kind === "flag" ? "checkbox" : "text", "data-option": name, placeholder });
      }
      add(label, "small", {}, help);
    }
  }

  const suffixOf = (name) => (/\.[^.]*$/.exec(name)?.[0] ?? "").toLowerCase();

  function chosen() {
    const options = {};
    for (const field of $("options").querySelectorAll("[data-option]")) {
      if (field.type === "checkbox" ? field.checked : field.value.trim()) {
        const value = field.type === "checkbox" ? true : field.value.trim();
        options[field.dataset.option] = field.placeholder === "A,B" ? value.split(",").map((name) => name.trim()) : value;
      }
    }
    return options;
  }

  /** Reads the file; with its options, and around a start, if it is read again. */
  async function read(again = false) {
    $("open-trouble").textContent = "Reading …";
    try {
      const asked = { suffix: suffixOf(file.name), options: JSON.stringify(again ? chosen() : {}) };
      const start = again ? $("file-start").value.trim() : "";
      if (start) asked.start = start;
      const told = await upload("api/open", file, asked);
      $("open-trouble").textContent = told.trouble;
      for (const [name, value] of Object.entries(told.options)) {
        const field = $("options").querySelector(`[data-option="${name}"]`);
        if (field?.type === "checkbox") field.checked = value === true;
        else if (field) field.value = value;
      }
      if (!told.trouble) dialog.close();
      show(told, file.name.replace(/\.[^.]*$/, ""));
      if (told.scene.start) $("file-start").value = state.drawing.start.map(text).join(",");
    } catch (error) {
      $("open-trouble").textContent = error.message;
    }
  }

  async function take(one) {
    if (!one) return;
    file = one;
    $("file-start").value = "";
    await offer();
    await read();
  }

  $("file").addEventListener("change", ({ target }) => {
    take(target.files[0]);
    target.value = "";
  });
  $("read-again").addEventListener("click", () => read(true));
  $("choose-file").addEventListener("click", () => $("file").click());
  document.addEventListener("dragover", (event) => event.preventDefault());
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    const [one] = event.dataTransfer.files;
    if (!one) return;
    if (!dialog.open) open();
    take(one);
  });

  function show(told, name) {
    const drawing = fromDocument(told.scene);
    const own = drawing.name && drawing.name !== "drawing" ? drawing.name : name;
    opened({ ...drawing, name: own, strategy: told.strategy });
  }

  function open() {
    list();
    $("open-trouble").textContent = "";
    if (!dialog.open) dialog.showModal();
  }

  // -- saving -----------------------------------------------------------------------------------

  const made = {
    scene: async () => {
      const saved = state.drawing;
      const found = [await receive("api/text", toRequest(saved)), ".json"];
      store.put({ saved });
      return found;
    },
    figure: async () => [await runs.file("figure", false), ".svg"],
    moment: async () => [await runs.file("figure", true), "-moment.svg"],
    trace: async () => [await runs.file("trace", false), "-run.json"],
    page: async () => [await runs.file("page", false), ".html"],
  };

  async function save(kind) {
    $("save").open = false;
    trouble("");
    document.body.dataset.busy = "save";
    $("doing").textContent = `writing the ${kind} …`;
    $("gauge").removeAttribute("value");
    try {
      const [blob, ending] = await made[kind]();
      const stem = (state.drawing.name || "scene").replace(/[^\p{L}\p{N} _-]/gu, "").trim().slice(0, 60) || "scene";
      download(blob, stem + ending);
    } catch (error) {
      trouble(error.message);
    }
    if (document.body.dataset.busy === "save") delete document.body.dataset.busy;
  }
  for (const button of $("save").querySelectorAll("[data-save]")) {
    button.addEventListener("click", () => save(button.dataset.save));
  }
  document.addEventListener("click", (event) => {
    if (!event.target.closest("#save")) $("save").open = false;
  });

  return { open, openGallery, save, show };
}

/** A small picture of a drawing. */
function sketch(parent, drawing) {
  const [left, bottom, right, top] = extentOfAll(drawing) ?? [0, 0, 1, 1];
  const scale = Math.min((WIDE - 8) / (right - left || 1), (HIGH - 8) / (top - bottom || 1));
  const at = ([x, y]) => [(x - (left + right) / 2) * scale + WIDE / 2, ((bottom + top) / 2 - y) * scale + HIGH / 2];
  const space = "http://www.w3.org/2000/svg";
  const svg = parent.appendChild(document.createElementNS(space, "svg"));
  svg.setAttribute("viewBox", `0 0 ${WIDE} ${HIGH}`);
  svg.setAttribute("aria-hidden", "true");
  if (drawing.terrain) {
    const line = lineOf({ vertices: cornersOf(drawing.terrain) }, at, scale);
    add(svg, "path", { class: "ground", d: line });
  }
  for (const shape of drawing.shapes) add(svg, "path", { class: shape.wall ? "wall" : "", d: lineOf(shape, at, scale) });
  if (drawing.start) {
    const [cx, cy] = at(drawing.start.map(({ n, d }) => Number(n) / Number(d)));
    add(svg, "circle", { cx, cy, r: 2.5 });
  }
}

function cornersOf({ x, y, width, height }) {
  const plus = (a, b) => ({ n: a.n * b.d + b.n * a.d, d: a.d * b.d });
  const [u, v] = [plus(x, width), plus(y, height)];
  return [[x, y], [u, y], [u, v], [x, v]].map(([a, b]) => ({ x: a, y: b, bend: null }));
}
