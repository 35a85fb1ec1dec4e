// What the page is once it is laid out, all of it unfolded, as its title, which is read from outside.
document.querySelectorAll("details").forEach((one) => { one.open = true; });
const box = (one) => one.getBoundingClientRect();
const seen = (one) => box(one).width > 40 && box(one).height > 40;
const every = (selector, of = document) => [...of.querySelectorAll(selector)];
const figures = every(".drawing > div");
const scrolls = "svg, .wide, .matrix, nav"; // may be wider than the page
const number = document.querySelector(".traced");
number.focus();
number.dispatchEvent(new KeyboardEvent("keydown", { key: "Enter", bubbles: true }));
const origin = document.getElementById("origin");
document.title = JSON.stringify({
  origin: origin.matches(":popover-open") ? origin.innerText : "",
  originFits: box(origin).left >= 0 && box(origin).right <= innerWidth,
  overflow: document.documentElement.scrollWidth - innerWidth,
  wide: every("main *")
    .filter((one) => !one.closest(scrolls) && box(one).right > innerWidth + 1)
    .map((one) => one.outerHTML.slice(0, 90)),
  figures: figures.length,
  shown: figures.filter((one) => every("svg", one).some(seen)).length,
  columns: every("svg.column").filter(seen).length,
});
