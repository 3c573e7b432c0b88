// Follows a flight: server-sent events update the drawings and readouts. Received text is inserted as text, never as markup.
const root = document.querySelector(".live-page");
const state = root.querySelector("[data-state]");
const job = root.dataset.job;
const trail = [];
const TRAIL_MOST = 3000;
let newest = 0;

const cell = (key) => root.querySelector(`[data-now="${key}"]`);
const put = (key, value) => {
  const at = cell(key);
  if (at && at.textContent !== value) at.textContent = value;
};
// The side view of a bridge shows only points near it: center, axis, and limits along and across the bridge, m.
function isNear(node, [e, n]) {
  if (!node.dataset.near) return true;
  const [east, north, alongEast, alongNorth, along, beside] = node.dataset.near.split(" ").map(Number);
  const x = (e - east) * alongEast + (n - north) * alongNorth;
  const y = (e - east) * alongNorth - (n - north) * alongEast;
  return Math.abs(x) <= along && Math.abs(y) <= beside;
}

function drawTrail(line) {
  let data = "", drawing = false;
  for (const point of trail) {
    const near = isNear(line, point);
    if (near) data += (drawing ? "L" : "M") + onSheet(line.dataset.matrix, point).map((x) => x.toFixed(1)).join(" ");
    drawing = near;
  }
  line.setAttribute("d", data);
}

function move(place) {
  const last = trail.at(-1);
  const far = !last || Math.hypot(...place.map((x, k) => x - last[k])) > 0.5;
  if (far) trail.push(place);
  if (trail.length > TRAIL_MOST) trail.splice(0, trail.length - TRAIL_MOST);
  for (const drone of root.querySelectorAll(".drone")) {
    moveDrone(drone, place);
    drone.classList.toggle("away", !isNear(drone, place));
  }
  if (!far) return;
  root.querySelectorAll(".trail").forEach(drawTrail);
}

function tell(words) {
  const list = root.querySelector("[data-said]");
  if (!list) return;
  // Message ids restart from 1 when the server restarts.
  if (words.at(-1)?.id < newest) newest = 0;
  for (const one of words) {
    if (one.id <= newest) continue;
    newest = one.id;
    const item = document.createElement("li");
    item.className = one.kind;
    item.textContent = `${clock(one.t_s)} ${one.words}`;
    // Messages of the vehicle are in English.
    item.lang = one.lang;
    list.prepend(item);
  }
  while (list.children.length > 60) list.lastChild.remove();
}

function showNames(selector, names) {
  const list = root.querySelector(selector);
  if (!list || list.dataset.now === names.join()) return;
  list.dataset.now = names.join();
  list.replaceChildren(...names.map((name) => {
    const item = document.createElement("li");
    item.textContent = name;
    return item;
  }));
}

function show(now) {
  if (now.job && now.job !== job) {
    location.reload();
    return;
  }
  state.textContent = flightState(now);
  state.classList.toggle("on", now.heard);
  if (!job) return;
  if (now.place) {
    root.classList.add("live");
    move(now.place);
  }
  moveWalker(root, now.inspector);
  put("task", now.task ?? texts.off_path);
  put("step", now.step ?? "–");
  put("progress", now.progress === null ? "–" : `${Math.floor(100 * now.progress)}%`);
  put("time", clock(now.t_s));
  put("speed", number(now.speed_m_s, 1, "m/s"));
  put("height", number(now.height_m, 1, "m"));
  put("clearance", number(now.clearance_m, 1, "m"));
  put("battery", number(now.battery_pct, 0, "%"));
  put("traffic", texts[`traffic_${now.traffic}`]);
  put("contact", texts[`contact_${now.contact}`]);
  showPicture(root.querySelector("[data-camera]"), now.picture, `/live/camera.jpg?vehicle=${root.dataset.vehicle}&`);
  for (const key of ["wind", "gnss", "compass", "radio"]) put(key, now[key] ?? "–");
  showNames("[data-cues]", now.cues);
  showNames("[data-hazards]", now.hazards);
  tell(now.words);
}

// Without a vehicle, there are no events.
if ("live" in root.dataset) {
  const source = new EventSource(`/live/stream?vehicle=${root.dataset.vehicle}`);
  source.onmessage = (event) => show(JSON.parse(event.data));
  source.onerror = () => {
    state.textContent = texts.not_connected;
    state.classList.remove("on");
  };
}

for (const form of root.querySelectorAll("form[data-act]")) {
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    const body = new URLSearchParams(new FormData(form, event.submitter));
    try {
      // A redirect leads to the login page; the action was not performed.
      const answer = await fetch(form.action, { method: "POST", body, headers: { Accept: "application/json" }, redirect: "manual" });
      if (answer.ok) form.querySelector("input[name=text]")?.form.reset();
      else state.textContent = answer.status ? texts.failed_status.replace("{status}", answer.status) : texts.failed_login;
    } catch (error) {
      console.error(error);
      state.textContent = texts.failed_silent;
    }
  });
}
