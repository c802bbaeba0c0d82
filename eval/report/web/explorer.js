// Which VPLs light which pixel: click a place for the VPLs that light it most, or a dot for what
// that VPL lights.

const noRow = 0xffffffff;
const reachPx = 9;  // CSS pixels within which a click takes a dot
const shownRows = 12;

// The bytes that contributions.py packed: lists of rows, strongest first, and their shares.
function unpackContributions(bytes, {width, height, perPixel, rows}) {
  const pixels = width * height, listed = pixels * perPixel, copy = bytes.slice();
  let at = 0;
  const take = (Type, count) => {
    const part = new Type(copy.buffer, at, count);
    at += part.byteLength;
    return part;
  };
  return {
    rowOf: take(Uint32Array, listed), pixelRadiance: take(Float32Array, pixels),
    x: take(Float32Array, rows), y: take(Float32Array, rows), radiance: take(Float32Array, rows),
    share: take(Uint16Array, listed), inSight: take(Uint8Array, rows),
  };
}

class Explorer {
  constructor(host, view, exponents) {
    Object.assign(this, {host, view, exponents, table: view.contributions, pixel: null, row: null});
    this.canvas = el("canvas", {"aria-hidden": "true"});
    this.box = el("div", {
      class: "explorer-picture", tabindex: "0", role: "application",
      "aria-label": "VPLs in the view: click, or move by arrow keys; Escape goes back",
      onclick: (e) => this.click(e), onkeydown: (e) => this.key(e)}, this.canvas);
    this.text = el("p", {class: "explorer-text", "aria-live": "polite"});
    this.list = el("tbody");
    this.rowTable = el("table", {class: "readout"},
        el("thead", {}, el("tr", {}, ...["VPL", "share of the pixel", ""].map(
            (t) => el("th", {scope: "col"}, t)))), this.list);
    this.back = el("button", {type: "button", onclick: () => this.choose(null, null)},
                   "All VPLs");
    host.replaceChildren(this.box, el("div", {class: "explorer-side"}, this.text, this.back,
                                      this.rowTable));
    host.setAttribute("aria-busy", "true");
    this.load();
  }

  async load() {
    const {view, table} = this;
    const shown = view.images.find((i) => i.id === view.first) ?? view.images[0];
    const file = shown.files[view.layers.at(-1).id] ?? Object.values(shown.files)[0];
    const [bytes, image] = await Promise.all([
      inflate(document.getElementById(table.element).textContent),
      loadHdr(file, view.width, view.height, this.exponents[file])]);
    this.data = unpackContributions(bytes, table);
    this.light = this.data.radiance.reduce((sum, v) => sum + v, 0);
    const pixels = new ImageData(view.width, view.height);
    paintExposed(image, view.exposure ?? autoExposure(image), pixels.data);
    this.photo = el("canvas", {width: view.width, height: view.height});
    this.photo.getContext("2d").putImageData(pixels, 0, 0);
    new ResizeObserver(() => this.layout()).observe(this.box);
    this.layout();
    this.choose(null, null);
    this.host.setAttribute("aria-busy", "false");
  }

  layout() {
    this.ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(this.box.clientWidth * this.ratio);
    this.canvas.height = Math.round(this.canvas.width * this.view.height / this.view.width);
    this.draw();
  }

  click(event) {
    const box = this.canvas.getBoundingClientRect();
    const x = (event.clientX - box.left) / box.width, y = (event.clientY - box.top) / box.height;
    const dot = this.dotAt(x, y, box);
    if (dot !== null) this.choose(null, dot);
    else this.choose([Math.floor(x * this.table.width), Math.floor(y * this.table.height)], null);
  }

  // The nearest dot that is drawn large within reach, or null.
  dotAt(x, y, box) {
    const {data} = this;
    let nearest = null, best = reachPx ** 2;
    for (const row of this.dots()) {
      const distance = ((data.x[row] - x) * box.width) ** 2 + ((data.y[row] - y) * box.height) ** 2;
      if (distance < best) [nearest, best] = [row, distance];
    }
    return nearest;
  }

  key(event) {
    const step = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[
        event.key];
    if (event.key === "Escape") this.choose(null, null);
    else if (!step) return;
    else {
      const {width, height} = this.table;
      const [x, y] = this.pixel ?? [width >> 1, height >> 1], fast = event.shiftKey ? 8 : 1;
      this.choose([x + fast * step[0], y + fast * step[1]], null);
    }
    event.preventDefault();
    event.stopPropagation();
  }

  choose(pixel, row) {
    const {width, height} = this.table;
    this.pixel = pixel && [clamp(pixel[0], 0, width - 1), clamp(pixel[1], 0, height - 1)];
    this.row = row;
    this.back.hidden = !pixel && row === null;
    this.rowTable.hidden = !pixel;
    this.tell();
    this.draw();
  }

  // [row, share] of the chosen pixel, strongest first.
  strongest() {
    const {data, table} = this, from = table.perPixel * (this.pixel[1] * table.width + this.pixel[0]);
    const found = [];
    for (let i = from; i < from + table.perPixel && data.rowOf[i] !== noRow; ++i) {
      found.push([data.rowOf[i], halfValues[data.share[i]]]);
    }
    return found;
  }

  // Share of the chosen VPL in each pixel; 0 where it is not among the strongest.
  sharesOfRow() {
    const {data, table} = this, shares = new Float32Array(table.width * table.height);
    data.rowOf.forEach((row, i) => {
      if (row === this.row) shares[Math.floor(i / table.perPixel)] = halfValues[data.share[i]];
    });
    return shares;
  }

  // Rows whose dots can be clicked: those of the pixel, or all in sight.
  dots() {
    const onFilm = (row) => !Number.isNaN(this.data.x[row]);
    if (this.pixel) return this.strongest().map(([row]) => row).filter(onFilm);
    const all = Array.from(this.data.x.keys());
    return all.filter((row) => onFilm(row) && this.data.inSight[row]);
  }

  tell() {
    const {data, table} = this;
    if (this.row !== null) {
      const shares = this.sharesOfRow();
      const lit = shares.reduce((n, v) => n + (v > 0), 0), most = Math.max(...shares);
      this.text.textContent = `VPL ${this.row} contributes ` +
          `${percentText(data.radiance[this.row] / this.light).replace("+", "")} of the VPLs' light in ` +
          `the picture. It is among the ${table.perPixel} strongest of ${lit} of ` +
          `${shares.length} pixels` +
          (lit ? `, with up to ${percentText(most).replace("+", "")} of a pixel (yellow).` : ".");
      return;
    }
    if (!this.pixel) {
      const seen = data.inSight.reduce((n, v) => n + v, 0);
      this.text.textContent = `${table.rows} VPLs with ${seen} in sight. Click a place in the ` +
          `picture: the ${table.perPixel} VPLs that light it most. Click a dot: what it lights.`;
      return;
    }
    const found = this.strongest();
    const hidden = found.filter(([row]) => !data.inSight[row] && !Number.isNaN(data.x[row])).length;
    const outside = found.filter(([row]) => Number.isNaN(data.x[row])).length;
    const sum = found.reduce((s, [, share]) => s + share, 0);
    const radiance = data.pixelRadiance[this.pixel[1] * table.width + this.pixel[0]];
    this.text.textContent = found.length === 0
        ? `Pixel (${this.pixel.join(", ")}) of ${table.width}×${table.height}: no VPL lights it.`
        : `Pixel (${this.pixel.join(", ")}) of ${table.width}×${table.height}: ${found.length} ` +
          `${found.length === 1 ? "VPL contributes" : "VPLs contribute"} ${percentText(Math.min(sum, 1)).replace("+", "")} of its VPL light, ` +
          `${numberText(radiance, 3)} W/(m² sr). Rings: ${hidden} behind surfaces. ` +
          `Outside the picture: ${outside}.`;
    this.list.replaceChildren(...found.slice(0, shownRows).map(([row, share]) => el("tr", {},
        el("th", {scope: "row"}, el("button", {type: "button", class: "name",
           onclick: () => this.choose(null, row)}, String(row))),
        el("td", {}, percentText(share).replace("+", "")),
        el("td", {}, Number.isNaN(data.x[row]) ? "outside" : data.inSight[row] ? "" : "hidden"))));
  }

  draw() {
    if (!this.data || !this.canvas.width) return;
    const context = this.canvas.getContext("2d"), {width, height} = this.canvas;
    context.globalAlpha = 1;
    context.fillStyle = "#000";
    context.fillRect(0, 0, width, height);
    context.globalAlpha = this.pixel || this.row !== null ? 0.5 : 0.8;
    context.drawImage(this.photo, 0, 0, width, height);
    context.globalAlpha = 1;
    if (this.row !== null) this.drawLit(context);
    if (this.pixel) this.drawPixel(context);
    if (!this.pixel && this.row === null) {
      for (const row of this.dots()) this.drawDot(context, row, 2.2, "#ffd633");
    }
  }

  drawPixel(context) {
    const {width, height} = this.canvas, found = this.strongest(), most = found[0]?.[1] ?? 1;
    // The strongest is drawn last.
    for (const [row, share] of [...found].reverse()) {
      const colour = 3 * Math.round(95 + 160 * share / most);
      this.drawDot(context, row, 2.5 + 7.5 * Math.sqrt(share / most),
                   `rgb(${errorRamp.subarray(colour, colour + 3).join(" ")})`);
    }
    const w = width / this.table.width, h = height / this.table.height;
    for (const [style, line] of [["#000", 3], ["#fff", 1.5]]) {
      context.strokeStyle = style;
      context.lineWidth = line * this.ratio;
      context.strokeRect(this.pixel[0] * w, this.pixel[1] * h, w, h);
    }
  }

  drawLit(context) {
    const shares = this.sharesOfRow(), most = Math.max(...shares, 1e-9);
    const {width, height} = this.table, pixels = new ImageData(width, height);
    paintRamp(shares.map((v) => 0.25 + 0.75 * v / most), errorRamp, pixels.data);
    shares.forEach((v, i) => { pixels.data[4 * i + 3] = v > 0 ? 225 : 0; });
    const map = el("canvas", {width, height});
    map.getContext("2d").putImageData(pixels, 0, 0);
    context.imageSmoothingEnabled = false;
    context.drawImage(map, 0, 0, this.canvas.width, this.canvas.height);
    context.imageSmoothingEnabled = true;
    this.drawDot(context, this.row, 6, "#fff");
  }

  // Rows behind surfaces are rings; those outside the film have no place.
  drawDot(context, row, radius, colour) {
    const {data, canvas, ratio} = this;
    if (Number.isNaN(data.x[row])) return;
    context.beginPath();
    context.arc(data.x[row] * canvas.width, data.y[row] * canvas.height, radius * ratio, 0,
                2 * Math.PI);
    context.lineWidth = 3 * ratio;
    context.strokeStyle = "rgb(0 0 0 / 0.75)";
    context.stroke();
    if (data.inSight[row]) {
      context.fillStyle = colour;
      context.fill();
    } else {
      context.lineWidth = 1.5 * ratio;
      context.strokeStyle = colour;
      context.stroke();
    }
  }
}
