// Where a number comes from: hover, tap or Enter on it opens a box; Escape or a tap elsewhere closes.
(() => {
  const box = document.getElementById("origin");
  if (!box.showPopover) return;
  const origins = JSON.parse(document.getElementById("origins").textContent);
  let shown;
  const place = () => {
    const at = shown.getBoundingClientRect();
    const below = at.bottom + box.offsetHeight < innerHeight;
    box.style.left = `${Math.max(4, Math.min(at.left, innerWidth - box.offsetWidth - 4))}px`;
    box.style.top = `${Math.max(4, below ? at.bottom : at.top - box.offsetHeight)}px`;
  };
  const open = (number) => {
    const id = number.dataset.id;
    const lines = [id, ...(origins[id.slice(0, id.lastIndexOf("/"))] ?? [])];
    box.replaceChildren(...lines.map((line) => {
      const p = document.createElement("p");
      p.textContent = line;
      return p;
    }));
    box.showPopover();
    shown = number;
    place();
  };
  const numberAt = (event) => event.target.closest?.(".traced");
  document.addEventListener("click", (event) => numberAt(event) && open(numberAt(event)));
  document.addEventListener("keydown", (event) => {
    if (!numberAt(event) || !["Enter", " "].includes(event.key)) return;
    event.preventDefault();
    open(numberAt(event));
  });
  document.addEventListener("pointerover", (event) => {
    if (event.pointerType !== "mouse") return;
    if (numberAt(event)) open(numberAt(event));
    else if (!box.contains(event.target)) box.hidePopover();
  });
  addEventListener("scroll", () => shown && place(), { passive: true }); // Tab may still scroll
})();
