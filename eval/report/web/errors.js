// False-colour maps against the reference. Definitions are those of vpl-inspect compare.

const eachPixel = (at) => (image, reference) =>
    Float32Array.from(image.bits[0], (_, i) => at(image, reference, i));

// map: one value for each pixel, of an image, the reference and, where `exposed`, the exposure.
const kinds = {
  relative: {
    title: "Difference",
    formula: "(image − reference) / (reference + 0.1 mean), mean of channels",
    map: eachPixel(relativeAt),
    ranges: [0.05, 0.1, 0.25, 0.5, 1, 2],
    initial: 0.5,
    rangeText: (r) => `±${100 * r} %`,
    share: (value, range) => 0.5 + 0.5 * value / range,
    colours: differenceRamp,
    ticks: (r) => [-1, -0.5, 0, 0.5, 1].map((t) => [0.5 + 0.5 * t,
        t === 0 ? "0" : minus(`${t > 0 ? "+" : ""}${100 * t * r} %`)]),
  },
  squared: {
    title: "Squared error",
    formula: "(image − reference)² / (reference² + 0.0001 mean²); its mean is relMSE",
    map: eachPixel(squaredAt),
    ranges: [0.001, 0.01, 0.1, 1, 10],
    initial: 1,
    rangeText: (r) => `up to ${r}`,
    // Four decades on a logarithmic scale.
    share: (value, range) => value > 0 ? 1 + Math.log10(value / range) / 4 : 0,
    colours: errorRamp,
    ticks: (r) => [0, 1, 2, 3, 4].map((t) => [t / 4, powerNode(Math.round(Math.log10(r)) + t - 4)]),
  },
  flip: {
    title: "FLIP",
    formula: "LDR-FLIP at the exposure shown, 67 pixels a degree: 0 looks alike",
    ranges: [0.1, 0.25, 0.5, 1],
    initial: 1,
    map: (image, reference, ev) => flipMap(image, reference, ev),  // of a script that comes later
    exposed: true,
    rangeText: (r) => `up to ${r}`,
    share: (value, range) => value / range,
    colours: errorRamp,
    ticks: (r) => [0, 0.5, 1].map((t) => [t, String(t * r)]),
  },
};

const powerNode = (n) => n === 0 ? "1" : el("span", {}, "10", el("sup", {}, minus(String(n))));

// Over all pixels and channels.
function meanOf(image) {
  if (image.mean === undefined) {
    const count = image.bits[0].length;
    let sum = 0;
    for (let k = 0; k < 3; ++k) {
      for (let i = 0; i < count; ++i) sum += channelAt(image, k, i);
    }
    image.mean = sum / (3 * count);
  }
  return image.mean;
}

function relativeAt(image, reference, i) {
  let a = 0, b = 0;
  for (let k = 0; k < 3; ++k) {
    a += channelAt(image, k, i) / 3;
    b += channelAt(reference, k, i) / 3;
  }
  const whole = Math.max(b, 0) + 0.1 * Math.abs(meanOf(reference));
  return a === b ? 0 : (a - b) / whole;
}

function squaredAt(image, reference, i) {
  const epsilon = 1e-4 * meanOf(reference) ** 2;
  let sum = 0;
  for (let k = 0; k < 3; ++k) {
    const b = channelAt(reference, k, i), error = (channelAt(image, k, i) - b) ** 2;
    if (error !== 0) sum += error / (b * b + epsilon);
  }
  return sum / 3;
}

// What `make` returns, kept with the image until it is held against another reference, or at
// another exposure where that matters.
function kept(image, reference, name, make, ev = 0) {
  const last = image.maps.get(name);
  if (last?.reference !== reference || last.ev !== ev) {
    image.maps.set(name, {reference, ev, value: make()});
  }
  return image.maps.get(name).value;
}

function errorMap(image, reference, kind, ev) {
  const {map, exposed} = kinds[kind];
  return kept(image, reference, kind, () => map(image, reference, ev), exposed ? ev : 0);
}

// What the list says of an image.
function summary(image, reference) {
  return kept(image, reference, "summary", () => {
    let relMse = 0;
    for (const value of errorMap(image, reference, "squared")) relMse += value;
    relMse /= image.bits[0].length;
    return {meanRatio: meanOf(image) / meanOf(reference), relMse};
  });
}
