// One view: its state, and what every key and control does to it.

class Viewer {
  constructor(host, view, exponents) {
    Object.assign(this, {host, view, exponents, ready: new Map(), painted: [null, null]});
    this.items = [...view.images, ...view.pictures];
    this.reference = view.images.findIndex((i) => i.id === view.reference);
    const a = Math.max(0, view.images.findIndex(
        (image, i) => (view.first === null ? i !== this.reference : image.id === view.first)));
    const b = this.reference >= 0 ? this.reference : Math.min(1, this.items.length - 1);
    this.state = {layer: view.layers[0].id, a, b, mode: "split", map: "image",
                  ev: view.exposure ?? 0,
                  ranges: Object.fromEntries(
                      Object.entries(kinds).map(([name, kind]) => [name, kind.initial]))};
    this.exposed = view.exposure !== null;
    this.panel = new Panel(view, this.items, this.state, this);
    const label = `${view.title}. The list of keys follows.`;
    this.stage = new Stage(host, view.width, view.height, label, {
      pixel: (x, y, spoken) => this.showPixel(x, y, spoken),
      zoom: () => { this.panel.zoomText.textContent = `${this.stage.zoom}×`; },
    });
    if (this.exposed) this.panel.setExposureRange(this.state.ev);
    this.build();
    this.setLayer(this.state.layer);
  }

  build() {
    const {panel, stage} = this;
    this.host.replaceChildren(panel.tools, el("div", {class: "left"}, stage.node, panel.legend,
        panel.captions), el("div", {class: "side"}, panel.list, panel.readout, panel.keys),
        panel.live);
    this.host.addEventListener("keydown", (e) => this.key(e));
  }

  available = (i) => i >= 0 &&
      (!this.items[i].files || this.state.layer in this.items[i].files);

  // The decoded image, or null while it is being decoded; the view is drawn again after that.
  decoded(i) {
    if (!this.available(i)) return null;
    const item = this.items[i];
    const key = item.files ? `${item.files[this.state.layer]}` : item.element;
    if (this.ready.has(key)) return this.ready.get(key);
    this.ready.set(key, null);
    const {width, height} = this.view;
    const loading = item.files
        ? loadHdr(Number(key), width, height, this.exponents[Number(key)]) : loadPicture(key);
    loading.then((image) => {
      this.ready.set(key, image);
      this.refresh();
    });
    return null;
  }

  refresh() {
    const {state, panel} = this;
    const reference = this.decoded(this.reference);
    const main = reference ?? this.decoded(this.reference < 0 ? 0 : state.a);
    if (!this.exposed && main && main.bits) this.autoExpose(true);
    panel.update(state, this.available);
    const sources = ["a", "b"].map((slot, k) => this.paint(k, state[slot], reference));
    this.stage.show(sources, ["a", "b"].map((slot) => {
      const item = this.items[state[slot]], map = this.mapOf(state[slot], reference);
      if (map === "image") return item.label;
      // In a sentence: "squared error", but FLIP.
      const title = kinds[map].title.replace(/^[A-Z](?=[a-z])/, (c) => c.toLowerCase());
      return `${item.label}: ${title}`;
    }), state.mode);
    this.host.setAttribute("aria-busy", String(sources.includes(null)));
    if (this.pixel) this.showPixel(...this.pixel, false);
    if (!sources.includes(null)) this.summarise(reference);
  }

  // The reference stays a picture: its own error is nothing to look at, and what is there is.
  mapOf(i, reference) {
    return reference && i !== this.reference && this.items[i].files ? this.state.map : "image";
  }

  // A canvas with the image as it is to be shown; repainted only if something of it changed.
  paint(k, i, reference) {
    const {state} = this, image = this.decoded(i);
    if (!image) return null;
    if (image.picture) return image.picture;
    const map = this.mapOf(i, reference);
    const exposed = map === "image" || kinds[map].exposed;
    const key = [i, state.layer, map, exposed && state.ev, state.ranges[map]].join();
    if (this.painted[k]?.key !== key) {
      const canvas = el("canvas", {width: image.width, height: image.height});
      const pixels = new ImageData(image.width, image.height);
      if (map === "image") {
        paintExposed(image, state.ev, pixels.data);
      } else {
        const kind = kinds[map], range = state.ranges[map];
        const shares = errorMap(image, reference, map, state.ev).map((v) => kind.share(v, range));
        paintRamp(shares, kind.colours, pixels.data);
      }
      canvas.getContext("2d").putImageData(pixels, 0, 0);
      this.painted[k] = {key, canvas};
    }
    return this.painted[k].canvas;
  }

  // Numbers in the list, one image after the other: decoding all of a view at once would stall it.
  summarise(reference) {
    const next = this.view.images.findIndex((_, i) => this.available(i) && !this.decoded(i));
    if (next >= 0 || !reference) return;
    this.view.images.forEach((_, i) => {
      const image = this.decoded(i), {numbers} = this.panel.rows[i];
      if (!image || i === this.reference) {
        numbers.textContent = "";
        return;
      }
      if (this.view.images[i].numbers) {  // judged elsewhere, by a better reference than the one shown
        numbers.textContent = this.view.images[i].numbers;
        return;
      }
      const {meanRatio, relMse} = summary(image, reference);
      numbers.textContent = `mean ratio ${meanRatio.toFixed(3)}, relMSE ${numberText(relMse, 3)}`;
    });
  }

  valuesAt(i, at, reference) {
    const image = this.decoded(i);
    if (!image) return null;
    if (image.picture) {
      const {width, height} = image.picture;
      const column = Math.floor((at % this.view.width + 0.5) * width / this.view.width);
      const row = Math.floor((Math.floor(at / this.view.width) + 0.5) * height / this.view.height);
      return {bytes: [0, 1, 2].map((k) => image.pixels[4 * (row * width + column) + k])};
    }
    const difference = reference && i !== this.reference ? relativeAt(image, reference, at) : null;
    return {rgb: [0, 1, 2].map((k) => channelAt(image, k, at)), difference};
  }

  showPixel(x, y, spoken) {
    this.pixel = [x, y];
    const reference = this.decoded(this.reference), at = y * this.view.width + x;
    const values = [this.state.a, this.state.b, this.reference].map(
        (i) => i < 0 ? null : this.valuesAt(i, at, reference));
    this.panel.showPixel(x, y, values);
    if (spoken) this.say([...this.panel.readout.querySelectorAll("caption, tbody tr")]
        .map((row) => [...(row.cells ?? [row])].map((c) => c.textContent).join(" ")).join("; "));
  }

  say(text) { this.panel.live.textContent = text; }

  change(part) {
    Object.assign(this.state, part);
    this.refresh();
  }

  setMode = (mode) => this.change({mode});
  setMap = (map) => this.change({map});

  // A slider may tell of more steps than can be painted: FLIP takes longer than a frame.
  setExposure = (ev) => {
    this.state.ev = ev;
    this.host.setAttribute("aria-busy", "true");
    this.frame ??= requestAnimationFrame(() => {
      this.frame = undefined;
      this.refresh();
    });
  };

  setRange = (range) => {
    this.state.ranges[this.state.map] = range;
    this.refresh();
  };

  setLayer = (layer) => {
    this.state.layer = layer;
    const first = this.items.findIndex((_, i) => this.available(i));
    for (const slot of ["a", "b"]) {
      if (!this.available(this.state[slot])) {
        this.state[slot] = this.available(this.reference) ? this.reference : first;
      }
    }
    this.refresh();
  };

  choose = (slot, i) => {
    if (i >= this.items.length || !this.available(i)) return;
    // Without the split one image is seen: the one just chosen.
    const mode = this.state.mode === "split" ? "split" : slot;
    this.change({[slot]: i, mode});
    this.say(`${slot.toUpperCase()}: ${this.items[i].label}`);
  };

  autoExpose = (first = false) => {
    const image = this.decoded(this.reference >= 0 ? this.reference : this.state.a);
    if (!image || !image.bits) return;
    this.state.ev = autoExposure(image);
    this.exposed = true;
    this.panel.setExposureRange(this.state.ev);
    if (!first) this.refresh();
  };

  zoomBy = (step) => this.stage.setZoom(this.stage.zoom * 2 ** step,
      ...(this.pixel && step > 0 ? this.pixel.map((v) => v + 0.5) : []));

  reset = () => {
    this.stage.setZoom(1);
    this.stage.setSplit(0.5);
    if (this.view.exposure !== null) this.state.ev = this.view.exposure;
    else this.autoExpose(true);
    this.change({mode: "split", map: "image"});
  };

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target.matches?.("select, textarea")) return;
    const digit = /^(Digit|Numpad)([1-9])$/.exec(event.code);
    const onStage = event.target === this.stage.box;
    let handled = true;
    if (digit) this.choose(event.shiftKey ? "b" : "a", Number(digit[2]) - 1);
    else if (onStage && event.key.startsWith("Arrow")) this.movePixel(event);
    else if (onStage && event.key === " ") this.flip();
    else handled = this.letter(event);
    if (handled) event.preventDefault();
  }

  letter(event) {
    const {state, stage, view} = this, maps = ["image", ...Object.keys(kinds)];
    const back = event.shiftKey ? -1 : 1;
    const actions = {
      f: () => this.flip(),
      s: () => this.setMode("split"),
      x: () => this.change({a: state.b, b: state.a}),
      m: () => view.reference !== null &&
          this.setMap(maps[(maps.indexOf(state.map) + back + maps.length) % maps.length]),
      l: () => {
        const ids = view.layers.map((layer) => layer.id);
        this.setLayer(ids[(ids.indexOf(state.layer) + 1) % ids.length]);
      },
      e: () => this.setExposure(clamp(state.ev + 0.5 * back, Number(this.panel.ev.min),
                                      Number(this.panel.ev.max))),
      a: () => this.autoExpose(),
      z: () => this.zoomBy(back),
      "+": () => this.zoomBy(1),
      "-": () => this.zoomBy(-1),
      "<": () => stage.setSplit(stage.split - 0.05),
      ">": () => stage.setSplit(stage.split + 0.05),
      r: () => this.reset(),
      h: () => { this.panel.keys.open = !this.panel.keys.open; },
    };
    const action = actions[event.key.toLowerCase()];
    if (action) action();
    return Boolean(action);
  }

  flip() { this.setMode(this.state.mode === "b" ? "a" : "b"); }

  movePixel(event) {
    const step = event.shiftKey ? 10 : 1;
    const [dx, dy] = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step],
                      ArrowDown: [0, step]}[event.key];
    const [x, y] = this.pixel ?? [this.view.width >> 1, this.view.height >> 1];
    this.stage.setPixel(x + dx, y + dy, true);
  }
}
