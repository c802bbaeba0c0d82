// LDR-FLIP (Andersson et al. 2020) between two images at an exposure. Constants, their sources and
// the reasons are in images/flip*; this is the same map for the exposure that is shown.

const flipPpd = 3840 * Math.PI / 180;  // pixels in a degree of the viewer's field

const whiteFromRgb = [
  [0.4123865632529917, 0.3575914909206253, 0.1804504912035637],
  [0.2126368216773238, 0.7151829818412507, 0.0721801964814255],
  [0.0193306201524840, 0.1191971636402082, 0.9503725870054354],
].map((row) => row.map((v) => v / (row[0] + row[1] + row[2])));

const rgbFromWhite = (() => {
  const cofactor = (i, j) => {
    const at = (a, b) => whiteFromRgb[(i + a) % 3][(j + b) % 3];
    return at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1);
  };
  const determinant = [0, 1, 2].reduce((sum, j) => sum + whiteFromRgb[0][j] * cofactor(0, j), 0);
  return [0, 1, 2].map((i) => [0, 1, 2].map((j) => cofactor(j, i) / determinant));
})();

const times = (m, v) => m.map((row) => row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);

function huntLab(rgb) {
  const f = (t) => t > (6 / 29) ** 3 ? Math.cbrt(t) : t / (3 * (6 / 29) ** 2) + 4 / 29;
  const [x, y, z] = times(whiteFromRgb, rgb).map(f), light = 116 * y - 16;
  return [light, 0.01 * light * 500 * (x - y), 0.01 * light * 200 * (y - z)];
}

const hyab = (a, b) => Math.abs(a[0] - b[0]) + Math.hypot(a[1] - b[1], a[2] - b[2]);

// Weights of `f` at -radius .. radius, positive ones to a sum of 1, negative ones to one of -1.
function flipKernel(radius, f) {
  const weights = Array.from({length: 2 * radius + 1}, (_, i) => f(i - radius));
  const sum = (sign) => weights.reduce((s, w) => s + Math.max(0, sign * w), 0);
  const positive = sum(1), negative = sum(-1);
  return weights.map((w) => w > 0 ? w / positive : w < 0 ? w / negative : 0);
}

const flipFilters = (() => {
  const widest = Math.ceil(3 * Math.sqrt(0.04 / (2 * Math.PI ** 2)) * flipPpd);
  const eye = (...terms) => {
    const made = terms.map(([a, b]) => {
      const f = (x) => Math.exp(-(Math.PI ** 2) * x * x / (flipPpd ** 2 * b));
      let sum = 0;
      for (let x = -widest; x <= widest; ++x) sum += f(x);
      return {kernel: flipKernel(widest, f), volume: a * Math.sqrt(Math.PI / b) * sum * sum};
    });
    const whole = made.reduce((sum, {volume}) => sum + volume, 0);
    return made.map(({kernel, volume}) => ({kernel, share: volume / whole}));
  };
  const deviation = 0.5 * 0.082 * flipPpd, radius = Math.ceil(3 * deviation);
  const gauss = (x) => Math.exp(-x * x / (2 * deviation * deviation));
  return {
    opponents: [eye([1, 0.0047]), eye([1, 0.0053]), eye([34.1, 0.04], [13.5, 0.025])],
    smooth: flipKernel(radius, gauss),
    features: [flipKernel(radius, (x) => -x * gauss(x)),
               flipKernel(radius, (x) => (x * x / deviation ** 2 - 1) * gauss(x))],
  };
})();

// Along rows or columns; beyond the borders the last pixel repeats.
function convolved(plane, kernel, width, along) {
  const height = plane.length / width, radius = kernel.length >> 1;
  const [length, step, lines, next] =
      along === "rows" ? [width, 1, height, width] : [height, width, width, 1];
  const out = new Float32Array(plane.length), padded = new Float64Array(length + 2 * radius);
  for (let line = 0; line < lines; ++line) {
    for (let i = 0; i < padded.length; ++i) {
      padded[i] = plane[line * next + clamp(i - radius, 0, length - 1) * step];
    }
    for (let i = 0; i < length; ++i) {
      let sum = 0;
      for (let k = 0; k < kernel.length; ++k) sum += kernel[k] * padded[i + k];
      out[line * next + i * step] = sum;
    }
  }
  return out;
}

const separably = (plane, width, acrossRows, acrossColumns) =>
    convolved(convolved(plane, acrossRows, width, "rows"), acrossColumns, width, "columns");

// What the eye makes of an image on a screen: colours as it resolves them, and strengths of edges
// and of points.
function appearance(image, ev) {
  const {width} = image, count = image.bits[0].length, gain = 2 ** ev;
  const opponents = [0, 1, 2].map(() => new Float32Array(count));
  for (let i = 0; i < count; ++i) {
    const screen = [0, 1, 2].map((k) => clamp(gain * channelAt(image, k, i), 0, 1));
    const [x, y, z] = times(whiteFromRgb, screen);
    opponents[0][i] = y;
    opponents[1][i] = x - y;
    opponents[2][i] = y - z;
  }
  const seen = opponents.map((plane, k) => {
    const parts = flipFilters.opponents[k].map(({kernel, share}) =>
        separably(plane, width, kernel, kernel).map((v) => share * v));
    return parts.length === 1 ? parts[0] : parts[0].map((v, i) => v + parts[1][i]);
  });
  const colours = Array.from({length: count}, (_, i) => {
    const y = seen[0][i], xyz = [y + seen[1][i], y, y - seen[2][i]];
    return huntLab(times(rgbFromWhite, xyz).map((v) => clamp(v, 0, 1)));
  });
  const features = flipFilters.features.map((kernel) => {
    const across = separably(opponents[0], width, kernel, flipFilters.smooth);
    const down = separably(opponents[0], width, flipFilters.smooth, kernel);
    return across.map((v, i) => Math.hypot(v, down[i]));
  });
  return {colours, features};
}

function flipMap(image, reference, ev) {
  const a = appearance(image, ev);
  const b = kept(reference, reference, "appearance", () => appearance(reference, ev), ev);
  const largest = hyab(huntLab([0, 1, 0]), huntLab([0, 0, 1])) ** 0.7, knee = 0.4 * largest;
  return Float32Array.from(a.colours, (colour, i) => {
    const power = hyab(colour, b.colours[i]) ** 0.7;
    const error = power < knee ? 0.95 * power / knee
                               : Math.min(1, 0.95 + 0.05 * (power - knee) / (largest - knee));
    const [edges, points] = a.features.map((f, k) => Math.abs(f[i] - b.features[k][i]));
    const feature = Math.min(1, Math.sqrt(Math.max(edges, points) / Math.SQRT2));
    return error > 0 ? error ** (1 - feature) : 0;
  });
}
