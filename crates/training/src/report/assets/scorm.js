// Reports the result to a learning management system through the SCORM 1.2 API of a parent or opener window.
"use strict";
const told = document.getElementById("told");
const texts = JSON.parse(document.body.dataset.texts);

function within(from) {
  let at = from;
  for (let depth = 0; depth < 10; depth += 1) {
    if (at.API) return at.API;
    if (!at.parent || at.parent === at) return null;
    at = at.parent;
  }
  return null;
}

const api = within(window) || (window.opener ? within(window.opener) : null);
if (api === null) {
  told.append(texts.missing);
} else {
  const ok = (answer) => String(answer) === "true";
  let done = ok(api.LMSInitialize(""));
  for (const [name, value] of Object.entries(JSON.parse(document.body.dataset.result))) done = ok(api.LMSSetValue(name, value)) && done;
  done = ok(api.LMSCommit("")) && done;
  told.append(done ? texts.sent : texts.refused);
  window.addEventListener("pagehide", () => api.LMSFinish(""));
}
