// Tables of class `sortable` are filtered and sorted; without this script they are plain tables.
// `words`: the texts, in the language of the page.
"use strict";
const every = (selector, of = document) => [...of.querySelectorAll(selector)];
const made = (name, attributes = {}, text = "") => {
  const element = document.createElement(name);
  Object.entries(attributes).forEach(([key, value]) => element.setAttribute(key, value));
  element.textContent = text;
  return element;
};
const DAY = 86400e3;
const today = Math.floor(Date.now() / DAY);

// A date says how long ago it is, or how soon; a due date that is over says so.
function span(days) {
  if (days < 60) return `${days} ${words.days}`;
  return days < 730 ? `${Math.round(days / 30.44)} ${words.months}` : `${(days / 365.25).toFixed(1)} ${words.years}`;
}
every(".sortable td[data-sort]").forEach((cell) => {
  const [, kind, date] = cell.dataset.sort.match(/^(date|due):(\d{4}-\d\d-\d\d)$/) ?? [];
  if (!date) return;
  const days = Math.floor(Date.parse(date) / DAY) - today;
  const over = kind === "due" && days < 0;
  const text = days < 0 ? words.ago : words.ahead;
  cell.append(" ", made("span", { class: over ? "age over" : "age" },
    over ? `${words.overdue} ${span(-days)}` : text.replace("{span}", span(Math.abs(days)))));
});

const value = (row, place) => {
  const cell = row.cells[place];
  return cell.dataset.sort ?? cell.textContent.trim();
};
// Numbers by size, all else by its letters, numbers in it by size; what is missing is last either way.
function order(one, other, descending) {
  const missing = (text) => text === "" || text === "—";
  if (missing(one) || missing(other)) return missing(one) - missing(other);
  const [a, b] = [Number(one), Number(other)];
  const size = isNaN(a) || isNaN(b) ? one.localeCompare(other, undefined, { numeric: true }) : a - b;
  return descending ? -size : size;
}

every("table.sortable").forEach((table, number) => {
  const body = table.tBodies[0];
  const rows = [...body.rows];
  const heads = every("thead tr:last-child th", table);
  const names = rows.length ? [...rows[0].cells].map((cell) => cell.dataset.label) : [];
  const status = made("p", { class: "status", role: "status" });
  const bar = made("div", { class: "controls" });
  const search = made("input", { type: "search", id: `filter-${number}`, autocomplete: "off" });
  const select = made("select", { id: `sort-${number}` });
  const labelled = (text, control) => {
    const label = made("label", { for: control.id }, text);
    bar.append(label, control);
  };
  let by = -1;
  let descending = false;

  const sort = (place, down) => {
    [by, descending] = [place, down];
    const sorted = place < 0 ? rows : [...rows].sort((a, b) => order(value(a, place), value(b, place), down));
    body.append(...sorted);
    heads.forEach((head, at) => {
      if (at === place) head.setAttribute("aria-sort", down ? "descending" : "ascending");
      else head.removeAttribute("aria-sort");
    });
    select.value = place < 0 ? "" : `${place} ${down}`;
  };
  const filter = () => {
    const wanted = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    const shown = rows.filter((row) => {
      const text = row.textContent.toLowerCase();
      row.hidden = !wanted.every((word) => text.includes(word));
      return !row.hidden;
    });
    status.textContent = words.shown.replace("{shown}", shown.length).replace("{all}", rows.length);
  };

  heads.forEach((head, place) => {
    const button = made("button", { type: "button" }, head.textContent);
    button.addEventListener("click", () => sort(place, by === place && !descending));
    head.replaceChildren(button);
  });
  select.append(made("option", { value: "" }, "–"));
  names.forEach((name, place) => [false, true].forEach((down) => {
    select.append(made("option", { value: `${place} ${down}` }, `${name} ${down ? "↓" : "↑"}`));
  }));
  select.addEventListener("change", () => {
    const [place, down] = select.value.split(" ");
    sort(select.value === "" ? -1 : Number(place), down === "true");
  });
  search.addEventListener("input", filter);
  search.addEventListener("keydown", (event) => {
    if (event.key === "Escape") { search.value = ""; filter(); }
  });
  labelled(words.filter, search);
  labelled(words.sort, select);
  table.closest("figure").querySelector("figcaption").after(bar, status);
  filter();
});
