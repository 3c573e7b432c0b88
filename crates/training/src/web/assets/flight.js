// Shows trainees the camera image of their own flight. Polls about once per second and loads each image once.
const root = document.querySelector("[data-flight]");
const state = root.querySelector("[data-state]");
const camera = root.querySelector("[data-camera]");
const EVERY_MS = 1000;

function show({ flying, picture }) {
  if (!flying) state.textContent = texts.none;
  else if (picture === null) state.textContent = texts.window;
  else state.textContent = texts.flying;
  showPicture(camera, picture, "/flight/camera.jpg?");
}

async function look() {
  try {
    // Hidden pages do not poll. A redirect means that the login has expired.
    if (!document.hidden) {
      const answer = await fetch("/flight/now.json", { redirect: "manual" });
      if (answer.ok) show(await answer.json());
      else state.textContent = answer.status ? texts.status.replace("{status}", answer.status) : texts.login;
    }
  } catch (error) {
    state.textContent = texts.not_connected;
  }
  setTimeout(look, EVERY_MS);
}

look();
