// Small helpers for elements and numbers.

function el(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false || value === undefined || value === null) continue;
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}

// Radio buttons that look like one bar: arrow keys and screen readers know them already.
function segments(caption, name, options, chosen, onChoose) {
  const inputs = new Map();
  const labels = options.map(([value, text]) => {
    const input = el("input", {type: "radio", name, value, onchange: () => onChoose(value)});
    input.checked = value === chosen;
    inputs.set(value, input);
    return el("label", {}, input, el("span", {}, text));
  });
  const node = el("fieldset", {class: "segments"}, el("legend", {}, caption),
                  el("div", {}, ...labels));
  return {node, inputs, set: (value) => { inputs.get(value).checked = true; }};
}

const clamp = (value, low, high) => Math.min(Math.max(value, low), high);
const minus = (text) => text.replace(/-/g, "−");

function numberText(value, digits = 4) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size < 1e-3 || size >= 1e6 ? value.toExponential(digits - 1)
                                          : value.toPrecision(digits);
  return minus(text.replace("e+", "e"));
}

function percentText(share) {
  if (!Number.isFinite(share)) return "–";
  const percent = 100 * share;
  const text = Math.abs(percent) < 10 ? percent.toFixed(2)
      : Math.abs(percent) < 1000 ? percent.toFixed(1) : percent.toExponential(1).replace("e+", "e");
  return minus((percent > 0 ? "+" : "") + text) + " %";
}

const signedText = (value) => minus((value > 0 ? "+" : "") + value.toFixed(2));
