// The picture area: two canvases of image pixels, enlarged, one left and one right of the split.

const zoomSteps = [1, 2, 4, 8, 16, 32];

class Stage {
  // on: {pixel(x, y, byKeyboard), zoom()}
  constructor(host, width, height, label, on) {
    Object.assign(this, {host, width, height, on, zoom: 1, split: 0.5, mode: "split", x: 0, y: 0});
    this.sources = [null, null];
    this.canvas = el("canvas", {"aria-hidden": "true"});
    this.handle = el("div", {class: "handle", role: "slider", tabindex: "0",
                             "aria-label": "Split: A to the left, B to the right",
                             "aria-valuemin": "0", "aria-valuemax": "100",
                             onkeydown: (e) => this.handleKey(e)}, el("span"));
    this.chips = [el("span", {class: "chip a"}), el("span", {class: "chip b"})];
    this.mark = el("div", {class: "mark", hidden: true});
    this.box = el("div", {class: "stage", tabindex: "0", role: "application",
                          "aria-roledescription": "image comparison", "aria-label": label},
                  this.canvas, ...this.chips, this.mark, this.handle);
    this.node = el("div", {class: "stage-room"}, this.box);
    this.listen();
    new ResizeObserver(() => this.layout()).observe(host);
  }

  // Whole device pixels for each image pixel where there is room for it: all are then of one size.
  layout() {
    const ratio = window.devicePixelRatio || 1;
    const room = this.room() * ratio, height = window.innerHeight * 0.78 * ratio;
    if (room <= 0) return;
    let fit = Math.min(room / this.width, Math.max(height / this.height, 1));
    if (fit >= 1) fit = Math.floor(fit);
    this.ratio = ratio;
    this.fit = fit;
    this.canvas.width = Math.round(this.width * fit);
    this.canvas.height = Math.round(this.height * fit);
    this.box.style.width = `${this.canvas.width / ratio}px`;
    this.box.style.height = `${this.canvas.height / ratio}px`;
    this.host.style.setProperty("--stage", this.box.style.width);
    this.draw();
  }

  // CSS pixels for the picture: beside the list, or, on a narrow page, the whole width.
  room() {
    const style = getComputedStyle(this.host);
    const em = parseFloat(getComputedStyle(document.documentElement).fontSize);
    const beside = style.gridTemplateColumns.split(" ").length > 1;
    return this.host.clientWidth - (beside ? 23 * em + parseFloat(style.columnGap) : 0);
  }

  get scale() { return this.fit * this.zoom; }

  // Device pixels between the enlarged image's corner and the canvas's.
  offset() {
    const at = (centre, size, room) => Math.round(
        clamp(centre * this.scale - room / 2, 0, size * this.scale - room));
    return [at(this.centreX ?? this.width / 2, this.width, this.canvas.width),
            at(this.centreY ?? this.height / 2, this.height, this.canvas.height)];
  }

  show(sources, labels, mode) {
    this.sources = sources;
    this.mode = mode;
    this.chips.forEach((chip, k) => {
      chip.textContent = `${"AB"[k]}  ${labels[k]}`;
      chip.hidden = mode !== "split" && mode !== "ab"[k];
    });
    this.handle.hidden = mode !== "split";
    this.draw();
  }

  draw() {
    if (!this.fit) return;
    const context = this.canvas.getContext("2d");
    const {width, height} = this.canvas, [left, top] = this.offset();
    const edge = this.mode === "split" ? Math.round(this.split * width)
        : this.mode === "a" ? width : 0;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, width, height);
    [[0, edge], [edge, width]].forEach(([from, to], k) => {
      if (!this.sources[k] || to <= from) return;
      context.save();
      context.beginPath();
      context.rect(from, 0, to - from, height);
      context.clip();
      // A picture may have more pixels than the image that it belongs to.
      context.imageSmoothingEnabled = this.scale * this.width < this.sources[k].width;
      context.setTransform(this.scale, 0, 0, this.scale, -left, -top);
      context.drawImage(this.sources[k], 0, 0, this.width, this.height);
      context.restore();
    });
    this.place(left, top);
  }

  place(left, top) {
    this.handle.style.left = `${100 * this.split}%`;
    this.handle.setAttribute("aria-valuenow", Math.round(100 * this.split));
    const size = this.scale / this.ratio;
    this.mark.style.width = this.mark.style.height = `${Math.max(size, 3)}px`;
    this.mark.style.left = `${(this.x * this.scale - left) / this.ratio}px`;
    this.mark.style.top = `${(this.y * this.scale - top) / this.ratio}px`;
    this.box.classList.toggle("zoomed", this.zoom > 1);
  }

  setSplit(share) {
    this.split = clamp(share, 0, 1);
    this.draw();
  }

  // Keeps the image point (x, y) where it is on the screen.
  setZoom(zoom, x = this.centreX ?? this.width / 2, y = this.centreY ?? this.height / 2) {
    const next = clamp(zoom, zoomSteps[0], zoomSteps.at(-1));
    const [left, top] = this.offset();
    const shareX = x * this.scale - left, shareY = y * this.scale - top;
    this.zoom = next;
    this.centreX = x + (this.canvas.width / 2 - shareX) / this.scale;
    this.centreY = y + (this.canvas.height / 2 - shareY) / this.scale;
    this.settle();
    this.draw();
    this.on.zoom();
  }

  // The centre to where offset() could put it: a drag beyond the rim must not have to come back.
  settle() {
    const [left, top] = this.offset();
    this.centreX = (left + this.canvas.width / 2) / this.scale;
    this.centreY = (top + this.canvas.height / 2) / this.scale;
  }

  setPixel(x, y, byKeyboard = false) {
    this.x = clamp(x, 0, this.width - 1);
    this.y = clamp(y, 0, this.height - 1);
    this.mark.hidden = false;
    if (byKeyboard) {  // the pixel stays in sight
      const halfX = this.width / this.zoom / 2, halfY = this.height / this.zoom / 2;
      this.settle();
      this.centreX = clamp(this.centreX, this.x + 1 - halfX, this.x + halfX);
      this.centreY = clamp(this.centreY, this.y + 1 - halfY, this.y + halfY);
      this.draw();
    } else {
      this.place(...this.offset());
    }
    this.on.pixel(this.x, this.y, byKeyboard);
  }

  imagePoint(event) {
    const box = this.canvas.getBoundingClientRect(), [left, top] = this.offset();
    return [((event.clientX - box.left) * this.ratio + left) / this.scale,
            ((event.clientY - box.top) * this.ratio + top) / this.scale];
  }

  listen() {
    let drag = null;
    const moveSplit = (e) => {
      const box = this.canvas.getBoundingClientRect();
      this.setSplit((e.clientX - box.left) / box.width);
    };
    this.box.addEventListener("pointerdown", (e) => {
      if (e.button !== 0) return;
      const onHandle = this.handle.contains(e.target);
      const what = this.mode === "split" && (onHandle || this.zoom === 1) ? "split"
          : this.zoom > 1 ? "pan" : null;
      drag = {what, x: e.clientX, y: e.clientY};
      this.box.setPointerCapture(e.pointerId);
      if (what === "split" && !onHandle) moveSplit(e);
      this.setPixel(...this.imagePoint(e).map(Math.floor));
    });
    this.box.addEventListener("pointermove", (e) => {
      if (drag?.what === "split") moveSplit(e);
      if (drag?.what === "pan") {
        this.settle();
        this.centreX -= (e.clientX - drag.x) * this.ratio / this.scale;
        this.centreY -= (e.clientY - drag.y) * this.ratio / this.scale;
        Object.assign(drag, {x: e.clientX, y: e.clientY});
        this.draw();
      }
      if (drag?.what !== "pan") this.setPixel(...this.imagePoint(e).map(Math.floor));
    });
    for (const end of ["pointerup", "pointercancel"]) {
      this.box.addEventListener(end, () => { drag = null; });
    }
    this.box.addEventListener("dblclick", (e) => {
      if (!this.handle.contains(e.target)) this.setZoom(2 * this.zoom, ...this.imagePoint(e));
    });
    this.box.addEventListener("wheel", (e) => {
      if (!e.ctrlKey) return;  // without Ctrl (and without a pinch) the wheel scrolls the page
      e.preventDefault();
      this.setZoom(e.deltaY < 0 ? 2 * this.zoom : this.zoom / 2, ...this.imagePoint(e));
    }, {passive: false});
  }

  handleKey(event) {
    const step = event.shiftKey ? 0.1 : 0.01;
    const to = {ArrowLeft: this.split - step, ArrowDown: this.split - step,
                ArrowRight: this.split + step, ArrowUp: this.split + step, Home: 0, End: 1};
    if (!(event.key in to)) return;
    event.preventDefault();
    event.stopPropagation();
    this.setSplit(to[event.key]);
  }
}
