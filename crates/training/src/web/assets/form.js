// Saves every answer immediately, one request at a time so that the latest one wins. Without this script, users save with
// the button.
"use strict";
const form = document.querySelector("form[data-save]");
const status = form.querySelector("[data-status]");
// Answers not yet confirmed by the server; included in the next save.
const unsaved = new Map();
let queue = Promise.resolve();

async function save() {
  if (unsaved.size === 0) return;
  const sent = new Map(unsaved);
  const body = new URLSearchParams();
  body.set("token", form.elements.token.value);
  body.set("language", form.elements.language.value);
  for (const [name, value] of sent) body.set(name, value);
  const tell = (words, bad) => {
    status.textContent = words;
    status.classList.toggle("bad", bad);
  };
  try {
    // The request completes even if the page is closed. A redirect leads to the login page and saves nothing.
    const headers = { Accept: "application/json" };
    const answer = await fetch(form.action, { method: "POST", body, headers, keepalive: true, redirect: "manual" });
    if (!answer.ok) throw new Error(`${answer.status ? `HTTP status ${answer.status}` : "login required"}`);
    const { answered, all } = await answer.json();
    for (const [name, value] of sent) if (unsaved.get(name) === value) unsaved.delete(name);
    tell(form.dataset.answered.replace("{answered}", answered).replace("{all}", all), false);
  } catch (error) {
    console.error(error);
    tell(form.dataset.notSaved, true);
  }
}

form.addEventListener("change", (event) => {
  const { name, value } = event.target;
  if (value === "") {
    unsaved.delete(name);
    return;
  }
  unsaved.set(name, value);
  queue = queue.then(save);
});
