// Unpacks what hdr_image.py packed: half floats, predicted, deflated, base64. An image stays in its
// half bits: 65536 possible values make every later mapping a table look-up.

const halfValues = (() => {
  const values = new Float32Array(65536);
  for (let bits = 0; bits < 65536; ++bits) {
    const exponent = (bits >> 10) & 31, mantissa = bits & 1023;
    const size = exponent === 0 ? mantissa * 2 ** -24 : (1024 + mantissa) * 2 ** (exponent - 25);
    values[bits] = bits & 0x8000 ? -size : size;
  }
  return values;
})();

async function inflate(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// One plane out of its residuals; 16-bit arithmetic wraps, as it did when packing.
function unpredict(low, high, width, height) {
  const out = new Int16Array(width * height);
  for (let y = 0, i = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x, ++i) {
      const code = low[i] | (high[i] << 8);
      const missed = code & 1 ? -((code + 1) >> 1) : code >> 1;
      let guess = 0;
      if (y === 0) {
        guess = x === 0 ? 0 : out[i - 1];
      } else if (x === 0) {
        guess = out[i - width];
      } else {
        const left = out[i - 1], above = out[i - width], corner = out[i - width - 1];
        const most = Math.max(left, above), least = Math.min(left, above);
        guess = corner >= most ? least : corner <= least ? most : left + above - corner;
      }
      out[i] = guess + missed;
    }
  }
  return out;
}

function unpack(bytes, width, height, exponent) {
  const count = width * height;
  const part = (k) => bytes.subarray(k * count, (k + 1) * count);
  const [green, red, blue] =
      [0, 1, 2].map((k) => unpredict(part(k), part(k + 3), width, height));
  for (let i = 0; i < count; ++i) {
    red[i] += green[i];
    blue[i] += green[i];
  }
  const bits = [red, green, blue].map((plane) => new Uint16Array(plane.buffer));
  return {width, height, exponent, bits, factor: 2 ** exponent, maps: new Map()};
}

const hdrImages = new Map();  // index -> promise

function loadHdr(index, width, height, exponent) {
  if (!hdrImages.has(index)) {
    const packed = document.getElementById(`hdr-${index}`).textContent;
    hdrImages.set(index, inflate(packed).then((b) => unpack(b, width, height, exponent)));
  }
  return hdrImages.get(index);
}

// A PNG of the page, as pixels.
async function loadPicture(elementId) {
  const source = document.getElementById(elementId);
  await source.decode();
  const canvas = el("canvas", {width: source.naturalWidth, height: source.naturalHeight});
  const context = canvas.getContext("2d", {willReadFrequently: true});
  context.drawImage(source, 0, 0);
  return {picture: canvas, pixels: context.getImageData(0, 0, canvas.width, canvas.height).data};
}

const channelAt = (image, k, i) => halfValues[image.bits[k][i]] * image.factor;
