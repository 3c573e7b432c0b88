// Updates the tiles of all flights about once per second. Received text is inserted as text, never as markup.
const root = document.querySelector("[data-tiles]");
const tiles = Array.from(root.querySelectorAll("[data-tile]"));
const EVERY_MS = 1000;

function put(tile, key, value) {
  const at = tile.querySelector(`[data-now="${key}"]`);
  if (at.textContent !== value) at.textContent = value;
}

function showCue(tile, now) {
  const at = tile.querySelector("[data-cue]");
  at.classList.toggle("on", now.cues.length > 0);
  if (now.cues.length > 0) at.textContent = now.cues.join(" · ");
  else at.textContent = now.last_cue === null ? texts.tile_no_cue : `${clock(now.last_cue.t_s)} ${now.last_cue.words}`;
}

function showHazards(tile, now) {
  const at = tile.querySelector("[data-hazards]");
  at.classList.toggle("on", now.hazards.length > 0);
  at.textContent = now.hazards.length > 0 ? now.hazards.join(" · ") : texts.tile_no_hazard;
}

function show(tile, now) {
  put(tile, "who", now.trainee ?? texts.tile_vehicle.replace("{number}", tile.dataset.tile));
  const state = tile.querySelector("[data-state]");
  state.textContent = flightState(now);
  state.classList.toggle("on", now.heard);
  put(tile, "task", now.step ?? now.task ?? texts.off_path);
  put(tile, "time", clock(now.t_s));
  put(tile, "battery", number(now.battery_pct, 0, "%"));
  showCue(tile, now);
  showHazards(tile, now);
  showPicture(tile.querySelector("[data-camera]"), now.picture, `/live/camera.jpg?vehicle=${tile.dataset.tile}&`);
  // The map replaces a missing picture.
  const map = tile.querySelector("[data-map]");
  map.hidden = now.picture !== null;
  if (!now.place) return;
  tile.classList.add("live");
  for (const drone of map.querySelectorAll(".drone")) moveDrone(drone, now.place);
  moveWalker(map, now.inspector);
}

function disconnected(words) {
  for (const tile of tiles) {
    const state = tile.querySelector("[data-state]");
    state.textContent = words;
    state.classList.remove("on");
  }
}

async function look() {
  try {
    // Hidden pages do not poll. A redirect means that the login has expired.
    if (!document.hidden) {
      const answer = await fetch("/live/all.json", { redirect: "manual" });
      if (answer.ok) {
        const { vehicles } = await answer.json();
        // A new job needs a new map.
        if (tiles.some((tile, k) => vehicles[k]?.job && vehicles[k].job !== tile.dataset.job)) {
          location.reload();
          return;
        }
        tiles.forEach((tile, k) => { if (vehicles[k]) show(tile, vehicles[k]); });
      } else {
        disconnected(answer.status ? texts.tile_status.replace("{status}", answer.status) : texts.tile_login);
      }
    }
  } catch (error) {
    disconnected(texts.tile_not_connected);
  }
  setTimeout(look, EVERY_MS);
}

look();
