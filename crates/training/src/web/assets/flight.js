// Follows the trainee's own flight: polls about once per second for the latest picture and shows each once.
"use strict";
const root = document.querySelector("[data-flight]");
const state = root.querySelector("[data-state]");
const camera = root.querySelector("[data-camera]");
const image = camera.querySelector("img");
const EVERY_MS = 1000;

function show({ flying, picture }) {
  if (!flying) state.textContent = "You are not flying. This page updates when your flight starts.";
  else if (picture === null) state.textContent = "You are flying; there is no picture of the camera (the window keeps it).";
  else state.textContent = "You are flying.";
  camera.hidden = picture === null;
  if (picture === null || image.dataset.picture === String(picture)) return;
  image.dataset.picture = String(picture);
  image.src = `/flight/camera.jpg?v=${picture}`;
}

async function look() {
  try {
    // A hidden page needs no picture; a redirect leads to the login.
    if (!document.hidden) {
      const answer = await fetch("/flight/now.json", { redirect: "manual" });
      if (answer.ok) show(await answer.json());
      else state.textContent = `not connected: the server says ${answer.status || "log in"}`;
    }
  } catch (error) {
    state.textContent = "not connected";
  }
  setTimeout(look, EVERY_MS);
}

look();
