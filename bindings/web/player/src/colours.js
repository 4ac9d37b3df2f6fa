// Numbers as colours.

// Viridis, by Smith and van der Walt, at five places.
const STOPS = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]].map((rgb) => rgb.map((x) => linear(x / 255)));

function linear(x) {
  return x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
}

/** Writes the colours of shares from 0 to 1, red, green and blue after one another. */
export function paint(shares, out) {
  shares.forEach((share, i) => {
    const place = Math.min(1, Math.max(0, share || 0)) * (STOPS.length - 1);
    const k = Math.min(Math.floor(place), STOPS.length - 2);
    for (let c = 0; c < 3; ++c) out[3 * i + c] = STOPS[k][c] + (place - k) * (STOPS[k + 1][c] - STOPS[k][c]);
  });
}

/** The size of each element of an attribute. */
export function sizes(values, channels) {
  return Float32Array.from({ length: values.length / channels }, (_, i) =>
    channels === 1 ? values[i] : Math.hypot(...values.subarray(channels * i, channels * (i + 1))));
}

/** Sizes as shares of the range that they have. */
export function shares(sizes) {
  let low = Infinity;
  let high = -Infinity;
  for (const x of sizes) {
    low = Math.min(low, x);
    high = Math.max(high, x);
  }
  return { low, high, shares: sizes.map((x) => (x - low) / (high - low || 1)) };
}
