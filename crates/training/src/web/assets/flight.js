// Shows trainees the camera image of their own flight. Polls about once per second and loads each image once.
const root = document.querySelector("[data-flight]");
const state = root.querySelector("[data-state]");
const camera = root.querySelector("[data-camera]");
const EVERY_MS = 1000;

function show({ flying, picture }) {
  if (!flying) state.textContent = "No flight in progress. This page updates when your flight starts.";
  else if (picture === null) state.textContent = "Flight in progress. The camera image is available only in the simulator window.";
  else state.textContent = "Flight in progress.";
  showPicture(camera, picture, "/flight/camera.jpg?");
}

async function look() {
  try {
    // Hidden pages do not poll. A redirect means that the login has expired.
    if (!document.hidden) {
      const answer = await fetch("/flight/now.json", { redirect: "manual" });
      if (answer.ok) show(await answer.json());
      else state.textContent = `Not connected: ${answer.status ? `HTTP status ${answer.status}` : "please log in"}`;
    }
  } catch (error) {
    state.textContent = "Not connected";
  }
  setTimeout(look, EVERY_MS);
}

look();
