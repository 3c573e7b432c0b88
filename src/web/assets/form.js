// Saves every answer as soon as it is given; one after the other, so that the last one counts. Without this script the form's button does.
"use strict";
const form = document.querySelector("form[data-save]");
const status = form.querySelector("[data-status]");
let queue = Promise.resolve();

async function save(field) {
  const body = new URLSearchParams();
  body.set("token", form.elements.token.value);
  body.set("language", form.elements.language.value);
  body.set(field.name, field.value);
  const tell = (words, bad) => {
    status.textContent = words;
    status.classList.toggle("bad", bad);
  };
  try {
    const answer = await fetch(form.action, { method: "POST", body, headers: { Accept: "application/json" } });
    if (!answer.ok) throw new Error(`the server says ${answer.status}`);
    const { answered, all } = await answer.json();
    tell(form.dataset.answered.replace("{answered}", answered).replace("{all}", all), false);
  } catch (error) {
    console.error(error);
    tell(form.dataset.notSaved, true);
  }
}

form.addEventListener("change", (event) => {
  if (event.target.value !== "") queue = queue.then(() => save(event.target));
});
