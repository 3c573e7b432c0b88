// The scenario editor. The server edits the text and checks it: this script sends each change, then shows the text, the values,
// the problems and the drawings of the answer. Without this script, users edit the text and check it with a button.
"use strict";
const PAUSE_MS = 400;
const editor = document.querySelector("[data-editor]");
const form = document.getElementById("editor");
const area = document.getElementById("text");
const fields = document.getElementById("fields");
const file = document.getElementById("file");
const status = document.getElementById("status");
const findings = document.getElementById("findings");
const preview = document.getElementById("preview");
const stale = document.getElementById("stale");
const placingStatus = document.getElementById("placing");
const placer = document.getElementById("placer");
const placerFields = document.getElementById("placer-fields");
const placedList = document.getElementById("placed-list");
const placedResult = document.getElementById("placed-result");
const texts = JSON.parse(editor.dataset.texts);

// Text of the saved file; null if it was never saved.
const saved = editor.dataset.unsaved === "true" ? null : area.defaultValue;
let shape = editor.dataset.shape ?? "";
// Changes that the server has not answered yet.
let edits = [];
// Texts typed since the last request, by the ID of the input.
let typed = new Map();
let timer = null;
let checking = null;
let checkedText = null;
let leaving = false;
// List of placed defects that the page shows.
let shownPlaced = null;
// Defects to place that have not been sent yet, one for each request.
let defects = [];
// Purpose of the next click on a drawing: whether any drawing or only the plan takes it, the function for it, the words meanwhile and
// the element that shows them, and the button that gets the focus.
let placing = null;
// Position of the caret in a field of a form that was replaced.
let caret = null;
// Edit whose answer moves the focus, and the function that moves it.
let focusNext = null;

const say = (element, words) => {
  if (element.textContent !== words) element.textContent = words;
};

// ---- Checks ----

function checkSoon() {
  clearTimeout(timer);
  timer = setTimeout(checkNow, PAUSE_MS);
}

/** Checks until no change is left; one request at a time. */
function checkNow() {
  clearTimeout(timer);
  checking ??= checkAll().finally(() => {
    checking = null;
    fields.inert = false;
    placedList.inert = false;
  });
  return checking;
}

async function checkAll() {
  while (edits.length > 0 || defects.length > 0 || area.value !== checkedText) {
    const sent = { text: area.value, edits, typed, defect: defects.shift() ?? null };
    edits = [];
    typed = new Map();
    try {
      const answer = await ask(sent);
      // Text typed in the meantime stays; the edits apply to it next.
      if (area.value === sent.text) {
        show(answer, sent);
        if (answer.rejected !== null) {
          notPlaced(sent, answer.rejected);
          return false;
        }
      } else {
        edits = [...sent.edits, ...edits];
        if (sent.defect !== null) defects.unshift(sent.defect);
      }
    } catch (error) {
      console.error(error);
      // Fields keep their values. A change of the form's structure is repeated with its button.
      edits = [...sent.edits, ...edits].filter((edit) => edit.set !== undefined);
      focusNext = null;
      say(status, error.words ?? texts.not_checked.replace("{reason}", error.message));
      notPlaced(sent, status.textContent);
      return false;
    }
  }
  return true;
}

/** Says why a defect of a request was not placed. The orders after it may depend on it. */
function notPlaced(sent, reason) {
  if (sent.defect === null) return;
  defects = [];
  placedResult.classList.add("field-problem");
  say(placedResult, texts.not_placed.replace("{reason}", reason));
}

async function ask({ text, edits: list, defect: order }) {
  const body = new URLSearchParams({ token: form.elements.token.value, opened: form.elements.opened.value, text, edits: JSON.stringify(list), shape });
  if (order !== null) body.append("defect", JSON.stringify(order));
  const answer = await fetch("/scenario-editor/check", { method: "POST", body, headers: { Accept: "application/json" }, redirect: "manual" });
  if (!answer.ok) {
    const words = answer.status ? texts.not_checked_status.replace("{status}", answer.status) : texts.not_checked_login;
    throw Object.assign(new Error(words), { words });
  }
  return answer.json();
}

// ---- Answers ----

function show(answer, sent) {
  // The result of the last save no longer applies to a changed text.
  if (area.value !== area.defaultValue) document.getElementById("notice")?.remove();
  if (area.value !== answer.text) area.value = answer.text;
  checkedText = area.value;
  fields.disabled = answer.values === null;
  showPlaced(answer);
  if (answer.form !== null) replaceForm(answer);
  if (answer.values !== null) showValues(answer.values);
  if (caret !== null) caret.input.setSelectionRange(caret.start, caret.end);
  caret = null;
  showProblems(answer.problems);
  const folds = ["check-warnings", "check-notes"];
  const open = folds.filter((id) => document.getElementById(id)?.open);
  findings.innerHTML = answer.findings;
  for (const id of open) document.getElementById(id)?.setAttribute("open", "");
  say(status, answer.rejected ? `${answer.rejected}. ${answer.status}` : answer.status);
  if (answer.preview !== null) preview.innerHTML = answer.preview;
  stale.hidden = answer.preview !== null || preview.querySelector("svg") === null;
  if (focusNext !== null && sent.edits.includes(focusNext.edit)) {
    // Nothing inert takes the focus.
    fields.inert = false;
    placedList.inert = false;
    focusNext.move();
    focusNext = null;
  }
}

function replaceForm(answer) {
  const open = [...fields.querySelectorAll("details[open]")].map((details) => details.id);
  const { id, selectionStart: start, selectionEnd: end } = fields.contains(document.activeElement) ? document.activeElement : {};
  fields.innerHTML = answer.form;
  shape = answer.shape;
  for (const id of open) document.getElementById(id)?.setAttribute("open", "");
  const focused = id ? document.getElementById(id) : null;
  focused?.focus();
  // The caret stays where it was; number fields have none.
  if (focused !== null && Number.isInteger(start)) caret = { input: focused, start, end };
}

function showValues(values) {
  for (const [id, value] of Object.entries(values)) {
    const input = document.getElementById(id);
    if (input === null) continue;
    if (typed.has(id)) input.value = typed.get(id);
    else if (input.value !== value && input !== document.activeElement) setValue(input, value);
  }
}

function showPlaced({ placed, placement }) {
  placerFields.disabled = placed === null;
  if (placed !== null && placed !== shownPlaced) placedList.innerHTML = placed;
  shownPlaced = placed ?? shownPlaced;
  if (placement === null) return;
  placedResult.classList.toggle("field-problem", !placement.done);
  say(placedResult, placement.text);
}

function setValue(input, value) {
  if (input instanceof HTMLSelectElement && ![...input.options].some((option) => option.value === value)) input.add(new Option(value, value));
  input.value = value;
}

/** Shows texts in a row, each in its own language. */
function sayEach(slot, words) {
  if (slot.textContent === words.map(({ text }) => text).join("; ")) return;
  const spans = words.map(({ text, lang }) => Object.assign(document.createElement("span"), { textContent: text, lang }));
  slot.replaceChildren(...spans.flatMap((span, k) => (k === 0 ? [span] : ["; ", span])));
}

function showProblems(problems) {
  const texts = new Map();
  for (const { element, ...words } of problems) if (element !== null) texts.set(element, [...(texts.get(element) ?? []), words]);
  for (const slot of fields.querySelectorAll(".field-problem")) {
    const id = slot.id.slice(0, -"-problem".length);
    const words = texts.get(id);
    sayEach(slot, words ?? []);
    for (const input of [document.getElementById(id), ...fields.querySelectorAll(`[id^="${CSS.escape(id)}-part-"]`)]) {
      if (!input?.dataset.field) continue;
      if (words) input.setAttribute("aria-invalid", "true");
      else input.removeAttribute("aria-invalid");
    }
  }
  for (const details of fields.querySelectorAll("details")) {
    details.classList.toggle("has-problem", [...details.querySelectorAll(".field-problem")].some((slot) => slot.textContent !== ""));
  }
}

// ---- Changes ----

function change(input) {
  const location = input.dataset.field;
  typed.set(input.id, input.value);
  let text = input.value;
  if (input.dataset.part !== undefined) {
    const parts = [...input.closest("fieldset").querySelectorAll("[data-part]")].map((part) => part.value.trim());
    text = parts.every((part) => part === "") ? "" : parts.join(", ");
  }
  edits = edits.filter((edit) => edit.set !== location);
  edits.push({ set: location, text });
  checkSoon();
}

// An empty field removes its key, and a select can change which keys exist, so both wait until the user has left the field or made
// the choice.
const waitsForChange = (input) => input instanceof HTMLSelectElement || input.value.trim() === "";
fields.addEventListener("input", ({ target }) => {
  if (target.dataset.field !== undefined && !waitsForChange(target)) change(target);
});
fields.addEventListener("change", ({ target }) => {
  if (target.dataset.field !== undefined && waitsForChange(target)) change(target);
});
area.addEventListener("input", checkSoon);

fields.addEventListener("click", ({ target }) => {
  const button = target.closest("button");
  if (button === null) return;
  if (button.dataset.place !== undefined) startPlacing({ button, set: (point) => setPosition(button, point), words: texts.place, status: placingStatus });
  if (button.dataset.edit !== undefined) editWith(button, (edit) => focusAfter(edit, button));
});

/** Sends the edit of a button. `next` returns the function that moves the focus after the answer. */
function editWith(button, next) {
  const edit = JSON.parse(button.dataset.edit);
  edits.push(edit);
  focusNext = { edit, move: next(edit) };
  // The other fields' places in the file change with the answer.
  fields.inert = true;
  placedList.inert = true;
  checkNow();
}

/** Returns a function that moves the focus to what the edit changed. */
function focusAfter(edit, button) {
  const section = button.closest("details.form-section").id;
  const last = () => {
    const groups = document.querySelectorAll(`#${section} details.group`);
    return groups[groups.length - 1];
  };
  if (edit.add !== undefined) {
    return () => {
      last()?.setAttribute("open", "");
      last()?.querySelector("[data-field]")?.focus();
    };
  }
  if (edit.remove !== undefined) return () => document.querySelector(`#${section} > [data-edit]`)?.focus();
  const index = Number(/\[(\d+)\]$/.exec(edit.move)[1]) + (edit.up ? -1 : 1);
  return () => {
    const group = document.querySelectorAll(`#${section} details.group`)[index];
    group?.setAttribute("open", "");
    group?.querySelector("summary")?.focus();
  };
}

// ---- Problems ----

findings.addEventListener("click", (event) => {
  const link = event.target.closest("[data-element]");
  const button = event.target.closest("[data-line]");
  if (link !== null) {
    event.preventDefault();
    const target = document.getElementById(link.dataset.element);
    for (let details = target; details !== null; details = details.parentElement.closest("details")) {
      if (details instanceof HTMLDetailsElement) details.open = true;
    }
    (target?.matches("input, select, textarea") ? target : target?.querySelector("input, select, summary"))?.focus();
  }
  if (button !== null) showLine(Number(button.dataset.line));
});

function showLine(line) {
  file.open = true;
  const lines = area.value.split("\n");
  const start = lines.slice(0, line - 1).reduce((length, text) => length + text.length + 1, 0);
  area.focus();
  area.setSelectionRange(start, start + (lines[line - 1] ?? "").length);
  area.scrollTop = (area.scrollHeight / Math.max(lines.length, 1)) * Math.max(line - 5, 0);
}

// ---- Placing ----

function startPlacing(next) {
  const plan = preview.querySelector("[data-plan]");
  if (plan === null) {
    say(next.status, texts.no_plan);
    return;
  }
  stopPlacing();
  placing = next;
  preview.classList.add(placing.anywhere ? "placing-defect" : "placing");
  plan.scrollIntoView({ block: "nearest" });
  say(placing.status, placing.words);
}

function stopPlacing() {
  if (placing !== null) say(placing.status, "");
  placing = null;
  preview.classList.remove("placing", "placing-defect");
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** Returns the line of sight at a click on a parallel projection: a point of it, m, and the unit vector away from the viewer. */
function lineOfSight(svg, event) {
  const matrix = svg.querySelector("[data-matrix]").dataset.matrix.split(" ").map(Number);
  const [right, down] = [matrix.slice(0, 3), matrix.slice(4, 7)];
  const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
  // Both rows have the same length and are perpendicular.
  const square = dot(right, right);
  const [x, y] = [(at.x - matrix[3]) / square, (at.y - matrix[7]) / square];
  const away = cross(right, down);
  const length = Math.hypot(...away);
  return { through_m: right.map((value, k) => value * x + down[k] * y), direction: away.map((value) => value / length) };
}

/** Sets east and north of a field to a point on the plan. */
function setPosition(button, { through_m: point }) {
  const parts = [...button.closest("fieldset").querySelectorAll("[data-part]")];
  point.slice(0, 2).forEach((value, k) => {
    parts[k].value = String(Math.round(10 * value) / 10);
    typed.set(parts[k].id, parts[k].value);
  });
  if (parts[2].value.trim() === "") parts[2].value = "0";
  change(parts[2]);
}

preview.addEventListener("click", (event) => {
  const svg = event.target.closest(placing?.anywhere ? "[data-drawing] svg" : "[data-plan] svg");
  if (placing === null || svg === null) return;
  const { set, button } = placing;
  // Clearing the words moves the drawing.
  const sight = lineOfSight(svg, event);
  stopPlacing();
  set(sight, svg.closest("[data-drawing]").dataset.drawing);
  button.focus();
});

document.addEventListener("keydown", (event) => {
  if (event.key === "Escape" && placing !== null) stopPlacing();
});

// ---- Defects ----

const choice = (id) => document.getElementById(id).value;

/** Sends a defect with the chosen kind and size. */
function placeDefect(place) {
  defects.push({
    kind: Number(choice("place-kind")),
    condition_state: Number(choice("place-state")),
    length_m: choice("place-length"),
    width_mm: choice("place-width"),
    turn_deg: choice("place-turn"),
    place,
  });
  say(placedResult, "");
  checkNow();
}

document.getElementById("place-on-drawing").addEventListener("click", ({ currentTarget: button }) => {
  placedResult.classList.remove("field-problem");
  startPlacing({
    button,
    anywhere: true,
    words: texts.place_defect,
    status: placedResult,
    set: ({ through_m, direction }, bridge) => {
      const sign = choice("place-surface") === "back" ? -1 : 1;
      placeDefect({ line: { through_m, direction: direction.map((value) => sign * value), bridge: bridge || null } });
    },
  });
});

document.getElementById("place-at-coordinates").addEventListener("click", () => {
  placeDefect({ near: [0, 1, 2].map((k) => choice(`place-at-${k}`)) });
});

placedList.addEventListener("click", ({ target }) => {
  const button = target.closest("[data-edit]");
  if (button === null) return;
  say(placedResult, "");
  editWith(button, () => () => document.getElementById("placed-head").focus());
});

/** Shows the typical size in the empty fields. */
function showTypicalSize() {
  const [length, width] = JSON.parse(placer.dataset.typical)[choice("place-kind")][choice("place-state")];
  document.getElementById("place-length").placeholder = length;
  document.getElementById("place-width").placeholder = width;
  document.getElementById("place-turn").placeholder = "0";
}
for (const id of ["place-kind", "place-state"]) document.getElementById(id).addEventListener("change", showTypicalSize);

// ---- Saving and leaving ----

const isUnsaved = () => saved === null || area.value !== saved || edits.length > 0 || defects.length > 0;

form.addEventListener("submit", (event) => {
  const { submitter } = event;
  if (submitter?.id === "download") {
    event.preventDefault();
    download();
  } else if (isPending()) {
    event.preventDefault();
    checkNow().then((done) => { if (done) form.requestSubmit(submitter); });
  } else {
    leaving = true;
  }
});

const isPending = () => edits.length > 0 || defects.length > 0 || checking !== null;

async function download() {
  if (isPending() && !(await checkNow())) say(status, texts.downloaded.replace("{status}", status.textContent));
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([area.value], { type: "application/toml" }));
  link.download = `${document.getElementById("field-name")?.value || "scenario"}.toml`;
  link.click();
  URL.revokeObjectURL(link.href);
}

document.getElementById("new-name").addEventListener("keydown", (event) => {
  if (event.key !== "Enter") return;
  event.preventDefault();
  form.requestSubmit(document.getElementById("save-as"));
});

addEventListener("beforeunload", (event) => {
  if (!leaving && isUnsaved()) event.preventDefault();
});

for (const element of document.querySelectorAll("[data-without-script]")) element.hidden = true;
fields.hidden = false;
placer.hidden = false;
showTypicalSize();
file.open = fields.childElementCount === 0;
fields.querySelector("details")?.setAttribute("open", "");
checkNow();
