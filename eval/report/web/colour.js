// From linear values to what a screen shows. The curve is that of the renderer's PNG previews:
// 2^EV, then sRGB's own, clamped.

function toSrgb8(linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 255;
  const encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055;
  return Math.floor(encoded * 255 + 0.5);
}

const exposureTables = new Map();  // stops -> the byte of each half

function exposureTable(stops) {
  let table = exposureTables.get(stops);
  if (!table) {
    if (exposureTables.size > 32) exposureTables.clear();
    table = new Uint8Array(65536);
    const factor = 2 ** stops;
    for (let bits = 0; bits < 0x7c00; ++bits) table[bits] = toSrgb8(halfValues[bits] * factor);
    exposureTables.set(stops, table);
  }
  return table;
}

function paintExposed(image, ev, out) {
  const table = exposureTable(ev + image.exponent);
  const [red, green, blue] = image.bits;
  for (let i = 0, at = 0; i < red.length; ++i, at += 4) {
    out[at] = table[red[i]];
    out[at + 1] = table[green[i]];
    out[at + 2] = table[blue[i]];
    out[at + 3] = 255;
  }
}

// So that the logarithmic mean of the luminance becomes middle grey, in quarter stops.
function autoExposure(image) {
  let sum = 0, lit = 0;
  for (let i = 0; i < image.bits[0].length; ++i) {
    const luminance = 0.2126 * channelAt(image, 0, i) + 0.7152 * channelAt(image, 1, i) +
        0.0722 * channelAt(image, 2, i);
    if (luminance > 0) {
      sum += Math.log2(luminance);
      ++lit;
    }
  }
  return lit > 0 ? Math.round((Math.log2(0.18) - sum / lit) * 4) / 4 : 0;
}

// 256 colours between evenly spaced stops.
function ramp(stops) {
  const colours = new Uint8Array(256 * 3);
  for (let i = 0; i < 256; ++i) {
    const t = (i / 255) * (stops.length - 1), from = Math.min(Math.floor(t), stops.length - 2);
    for (let k = 0; k < 3; ++k) {
      colours[3 * i + k] =
          Math.round(stops[from][k] + (stops[from + 1][k] - stops[from][k]) * (t - from));
    }
  }
  return colours;
}

// The colours of vpl-inspect compare --diff.
const differenceRamp = ramp([[15, 30, 120], [90, 150, 235], [255, 255, 255], [240, 110, 80],
                             [125, 10, 25]]);
// Lightness grows steadily, so that it can be read in grey.
const errorRamp = ramp([[6, 8, 24], [52, 22, 96], [122, 32, 112], [190, 55, 90], [234, 100, 55],
                        [250, 165, 50], [252, 240, 175]]);

// `share` 0..1 along the ramp.
function paintRamp(shares, colours, out) {
  for (let i = 0, at = 0; i < shares.length; ++i, at += 4) {
    const from = 3 * Math.round(255 * clamp(shares[i], 0, 1));
    out[at] = colours[from];
    out[at + 1] = colours[from + 1];
    out[at + 2] = colours[from + 2];
    out[at + 3] = 255;
  }
}
