// Tables with filters: rows are chosen by what their cells say, sorted by a column, and show their
// picture below them, in the viewer of its view. One measure can be seen alone.

class ResultTable {
  constructor(block, show) {
    this.table = block.querySelector("table");
    this.show = show;
    this.bodies = [...this.table.tBodies].map((body) => ({
      body, heading: body.querySelector(".group"),
      rows: [...body.querySelectorAll("tr:not(.group)")],
    }));
    this.rows = this.bodies.flatMap(({rows}) => rows);
    this.sorted = el("tbody");
    this.order = {column: -1, down: false};
    this.chosen = new Map();  // column -> text
    const measures = block.querySelector(".filters .measures");
    measures?.addEventListener("change", () => this.measure(measures));
    for (const list of block.querySelectorAll(".filters select[data-column]")) {
      list.addEventListener("change", () => this.filter(Number(list.dataset.column), list.value));
    }
    for (const button of this.table.querySelectorAll("thead button")) {
      button.addEventListener("click", () => this.sort(Number(button.dataset.column)));
    }
    for (const button of this.table.querySelectorAll("button.picture")) {
      button.addEventListener("click", () => this.toggle(button));
    }
  }

  filter(column, text) {
    this.close();
    if (text) this.chosen.set(column, text);
    else this.chosen.delete(column);
    for (const row of this.rows) {
      row.hidden = [...this.chosen].some(([c, t]) => row.cells[c].dataset.value !== t);
    }
    for (const {heading, rows} of this.bodies) {
      if (heading) heading.hidden = rows.every((row) => row.hidden);
    }
  }

  // Hides the columns of all measures but the chosen one; none is chosen by "".
  measure(list) {
    this.close();
    const places = [...list.options].map((option) => option.value).filter((value) => value);
    for (const row of [this.table.tHead.rows[0], ...this.rows]) {
      for (const k of places) row.cells[k].hidden = list.value !== "" && k !== list.value;
    }
  }

  // The first click on a column puts its small values first, the second its large ones, the third
  // restores the groups.
  sort(column) {
    this.close();
    const again = column === this.order.column;
    this.order = again && this.order.down ? {column: -1, down: false} : {column, down: again};
    for (const head of this.table.tHead.rows[0].cells) head.removeAttribute("aria-sort");
    if (this.order.column < 0) return this.restore();
    const head = this.table.tHead.rows[0].cells[column], sign = this.order.down ? -1 : 1;
    head.setAttribute("aria-sort", this.order.down ? "descending" : "ascending");
    const value = (row) => row.cells[column].dataset.value;
    const known = this.rows.filter((row) => value(row) !== "");
    const numbers = known.every((row) => Number.isFinite(Number(value(row))));
    const compare = numbers ? (a, b) => Number(value(a)) - Number(value(b))
                            : (a, b) => value(a).localeCompare(value(b));
    known.sort((a, b) => sign * compare(a, b));
    this.sorted.replaceChildren(...known, ...this.rows.filter((row) => value(row) === ""));
    for (const {body} of this.bodies) body.remove();
    this.table.append(this.sorted);
  }

  restore() {
    this.sorted.remove();
    for (const {body, heading, rows} of this.bodies) {
      body.replaceChildren(...(heading ? [heading] : []), ...rows);
      this.table.append(body);
    }
  }

  toggle(button) {
    const was = this.open?.button === button;
    this.close();
    if (was) return;
    const row = button.closest("tr"), room = el("div", {class: "inline"});
    const below = el("tr", {class: "shown"}, el("td", {colspan: row.cells.length}, room));
    room.style.width = `${this.table.parentElement.clientWidth}px`;
    row.after(below);
    button.setAttribute("aria-expanded", "true");
    this.open = {button, below, back: this.show(button, room)};
  }

  close() {
    if (!this.open) return;
    this.open.back();
    this.open.below.remove();
    this.open.button.setAttribute("aria-expanded", "false");
    this.open = null;
  }
}
