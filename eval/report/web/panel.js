// The controls around a stage: tool bar, list of images, pixel values, legend and keys.

let panelCount = 0;

const keyHelp = [
  ["1–9", "A: image n"], ["Shift 1–9", "B: image n"], ["f", "flip between A and B"],
  ["s", "split"], ["x", "exchange A and B"], ["m", "image, difference, error, FLIP"],
  ["l", "next layer"], ["e  Shift e", "exposure ±0.5 EV"], ["a", "automatic exposure"],
  ["z  Shift z", "zoom in, out"], ["< >", "move the split"], ["arrows", "move the pixel"],
  ["r", "reset"], ["h", "these keys"],
];

class Panel {
  // view as in the page's data; act: the viewer's methods
  constructor(view, items, state, act) {
    const name = `panel-${panelCount++}`;
    this.items = items;
    this.layer = segments("Layer", `${name}-layer`, view.layers.map((l) => [l.id, l.title]),
                          state.layer, act.setLayer);
    this.mode = segments("Compare", `${name}-mode`, [["split", "Split"], ["a", "A"], ["b", "B"]],
                         state.mode, act.setMode);
    const maps = [["image", "Image"], ...Object.entries(kinds).map(([k, v]) => [k, v.title])];
    this.map = segments("Show", `${name}-map`, maps, state.map, act.setMap);
    if (view.reference === null) {
      for (const key of Object.keys(kinds)) this.map.inputs.get(key).disabled = true;
    }
    this.makeExposure(act);
    this.makeZoom(act);
    this.tools = el("div", {class: "tools"},
                    view.layers.length > 1 ? this.layer.node : null, this.mode.node, this.map.node,
                    this.exposure, this.zoom);
    this.makeList(name, view, act);
    this.makeLegend(act);
    this.makeReadout();
    this.captions = el("div", {class: "captions"});
    this.keys = el("details", {class: "keys"}, el("summary", {}, "Keys"),
                   el("p", {class: "fine"},
                      "They go to the viewer that has the focus or is under the pointer."),
                   el("dl", {}, ...keyHelp.map(([keys, text]) => el("div", {},
                      el("dt", {}, ...keys.split("  ").map((k) => el("kbd", {}, k))),
                      el("dd", {}, text)))));
    this.live = el("div", {class: "hidden", "aria-live": "polite"});
  }

  makeExposure(act) {
    this.ev = el("input", {type: "range", class: "ev", step: "0.25", "aria-label": "Exposure",
                           oninput: () => act.setExposure(Number(this.ev.value))});
    this.evText = el("output", {class: "ev-text"});
    this.exposure = el("fieldset", {class: "exposure"}, el("legend", {}, "Exposure"), el("div", {},
        this.ev, this.evText,
        el("button", {type: "button", title: "Middle grey for the reference's logarithmic mean",
                      onclick: () => act.autoExpose()}, "Auto")));
  }

  makeZoom(act) {
    const button = (text, label, step) => el("button", {
      type: "button", "aria-label": label, onclick: () => act.zoomBy(step)}, text);
    this.zoomText = el("output", {class: "zoom-text"}, "1×");
    this.zoom = el("fieldset", {class: "zoom"}, el("legend", {}, "Zoom"), el("div", {},
        button("−", "Zoom out", -1), this.zoomText, button("+", "Zoom in", 1),
        el("button", {type: "button", onclick: () => act.reset()}, "Reset")));
  }

  makeList(name, view, act) {
    this.rows = this.items.map((item, i) => {
      const radio = (slot) => el("input", {
        type: "radio", name: `${name}-${slot}`,
        "aria-label": `${slot.toUpperCase()}: ${item.label}`, onchange: () => act.choose(slot, i)});
      const a = radio("a"), b = radio("b");
      const numbers = el("small", {class: "numbers"});
      const isReference = item.id === view.reference && !item.element;
      const title = el("button", {type: "button", class: "name", tabindex: "-1",
                                  title: "Choose as A; with Shift, as B",
                                  onclick: (e) => act.choose(e.shiftKey ? "b" : "a", i)},
                       item.label, isReference ? el("small", {}, " reference") : null);
      const row = el("tr", {}, el("td", {}, i < 9 ? el("kbd", {}, String(i + 1)) : ""),
                     el("th", {scope: "row"}, title, numbers), el("td", {}, a), el("td", {}, b));
      return {row, a, b, numbers};
    });
    this.list = el("table", {class: "list"},
                   el("thead", {}, el("tr", {}, el("th", {}, el("span", {class: "hidden"}, "Key")),
                      el("th", {scope: "col"}, "Image"), el("th", {scope: "col"}, "A"),
                      el("th", {scope: "col"}, "B"))),
                   el("tbody", {}, ...this.rows.map((r) => r.row)));
  }

  makeLegend(act) {
    this.bar = el("canvas", {width: 256, height: 1});
    this.ticks = el("div", {class: "ticks"});
    this.formula = el("span", {class: "formula"});
    this.range = el("select", {onchange: () => act.setRange(Number(this.range.value))});
    this.legend = el("div", {class: "legend", role: "group", "aria-label": "Legend"},
                     el("div", {class: "scale"}, this.bar, this.ticks),
                     el("p", {}, this.formula, el("label", {}, "Range ", this.range)));
  }

  makeReadout() {
    this.pixel = el("caption", {}, "Pixel values: point at the image");
    this.cells = ["A", "B", "Reference"].map((name) => {
      const cells = Array.from({length: 4}, () => el("td", {}, "–"));
      return {row: el("tr", {}, el("th", {scope: "row"}, name), ...cells), cells};
    });
    const head = ["", "R", "G", "B", "difference"].map((t) => el("th", {scope: "col"}, t));
    this.readout = el("table", {class: "readout"}, this.pixel,
                      el("thead", {}, el("tr", {}, ...head)),
                      el("tbody", {}, ...this.cells.map((c) => c.row)));
  }

  setExposureRange(ev) {
    this.ev.min = ev - 8;
    this.ev.max = ev + 8;
  }

  // Everything that follows from the state alone.
  update(state, available) {
    this.layer.set(state.layer);
    this.mode.set(state.mode);
    this.map.set(state.map);
    this.ev.value = state.ev;
    this.evText.textContent = `${signedText(state.ev)} EV`;
    this.ev.setAttribute("aria-valuetext", this.evText.textContent);
    this.rows.forEach((r, i) => {
      r.a.checked = i === state.a;
      r.b.checked = i === state.b;
      r.a.disabled = r.b.disabled = !available(i);
      r.row.classList.toggle("absent", !available(i));
      r.row.classList.toggle("chosen", i === state.a || i === state.b);
    });
    this.captions.replaceChildren(...["a", "b"].map((slot) => {
      const item = this.items[state[slot]];
      return item.caption ? el("p", {}, el("b", {}, `${slot.toUpperCase()}  ${item.label}. `),
                               item.caption) : null;
    }).filter((p) => p));
    this.updateLegend(state);
  }

  updateLegend(state) {
    this.legend.hidden = state.map === "image";
    if (this.legend.hidden) return;
    const kind = kinds[state.map], range = state.ranges[state.map];
    const pixels = new ImageData(256, 1);
    paintRamp(Float32Array.from({length: 256}, (_, i) => i / 255), kind.colours, pixels.data);
    this.bar.getContext("2d").putImageData(pixels, 0, 0);
    this.ticks.replaceChildren(...kind.ticks(range).map(([share, text]) => {
      const tick = el("span", {}, text);
      tick.style.left = `${100 * share}%`;
      return tick;
    }));
    this.formula.textContent = kind.formula;
    this.range.replaceChildren(...kind.ranges.map((r) => el("option", {value: r},
                                                            kind.rangeText(r))));
    this.range.value = range;
  }

  // values: for A, B and reference {rgb: [..], difference} or null
  showPixel(x, y, values) {
    this.pixel.textContent = `Pixel (${x}, ${y}), linear`;
    values.forEach((v, i) => {
      const {cells} = this.cells[i];
      cells.forEach((cell, k) => {
        if (!v) cell.textContent = "–";
        else if (k < 3) cell.textContent = v.bytes ? v.bytes[k] : numberText(v.rgb[k]);
        else cell.textContent = v.bytes ? "8 bit" : v.difference === null ? "–"
            : percentText(v.difference);
      });
    });
  }
}
