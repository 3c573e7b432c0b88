// Updates the table of stations every two seconds, and which stations can be selected.
const EVERY_MS = 2000;

async function look() {
  try {
    // Hidden pages do not poll. A redirect means that the login has expired.
    const answer = document.hidden ? null : await fetch("/stations/now", { redirect: "manual" });
    if (answer && answer.ok) {
      const page = new DOMParser().parseFromString(await answer.text(), "text/html");
      update(page);
    }
  } catch {
    // The server is not reachable at the moment.
  }
  setTimeout(look, EVERY_MS);
}

function update(page) {
  const [mine, theirs] = [document, page].map((one) => one.getElementById("station-table"));
  // The first station changes the whole page.
  if (!mine || !theirs) {
    if (mine !== theirs) location.reload();
    return;
  }
  if (mine.innerHTML !== theirs.innerHTML) mine.replaceChildren(...theirs.childNodes);
  const [select, fresh] = [document, page].map((one) => one.querySelector("select[name=station]"));
  const names = (one) => Array.from(one.options, (option) => option.value).join(" ");
  if (names(select) === names(fresh)) {
    Array.from(select.options).forEach((option, k) => { option.disabled = fresh.options[k].disabled; });
  } else {
    const chosen = select.value;
    select.replaceChildren(...fresh.childNodes);
    select.value = chosen;
  }
}

setTimeout(look, EVERY_MS);
