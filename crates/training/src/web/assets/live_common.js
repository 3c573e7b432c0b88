// Functions shared by the pages about live flights. Each of these pages loads one file, which begins with these functions.
"use strict";
const texts = JSON.parse(document.querySelector("[data-texts]").dataset.texts);
const number = (value, digits, unit) => (value === null ? "–" : `${value.toFixed(digits)}${unit === "%" ? "" : " "}${unit}`);
const clock = (t) => (t === null ? "–" : `${Math.floor(t / 60)}:${String(Math.floor(t % 60)).padStart(2, "0")}`);
const flightState = (now) => (now.heard ? (now.frozen ? texts.frozen : now.armed ? texts.armed : texts.disarmed) : texts.silent);

function onSheet(matrix, [e, n, u]) {
  const m = matrix.split(" ").map(Number);
  return [m[0] * e + m[1] * n + m[2] * u + m[3], m[4] * e + m[5] * n + m[6] * u + m[7]];
}

function moveDrone(drone, place) {
  const [x, y] = onSheet(drone.dataset.matrix, place);
  drone.setAttribute("transform", `translate(${x.toFixed(1)} ${y.toFixed(1)})`);
}

// The inspector in the drawings, if the job has places to walk to.
function moveWalker(root, place) {
  if (!place) return;
  root.querySelectorAll(".walker").forEach((walker) => moveDrone(walker, place));
}

// Each image has a unique URL and is requested once; the previous image stays until the new one has loaded.
function showPicture(camera, version, address) {
  camera.hidden = version === null;
  const image = camera.querySelector("img");
  if (version === null || image.dataset.picture === String(version)) return;
  image.dataset.picture = String(version);
  image.src = `${address}v=${version}`;
}
