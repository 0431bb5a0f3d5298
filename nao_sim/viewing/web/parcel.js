// Opens what the page carries: base64 of gzip of a length, JSON and arrays.

const UNKNOWN = -32768; // stands for no number
const TYPES = { u1: Uint8Array, i1: Int8Array, u2: Uint16Array, i2: Int16Array, u4: Uint32Array, f4: Float32Array };

async function openParcel(text) {
  const squeezed = Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0));
  const stream = new Blob([squeezed]).stream().pipeThrough(new DecompressionStream("gzip"));
  const whole = await new Response(stream).arrayBuffer();
  const size = new DataView(whole).getUint32(0, true);
  const told = JSON.parse(new TextDecoder().decode(new Uint8Array(whole, 4, size)));
  for (const [name, row] of Object.entries(told.arrays)) told.arrays[name] = arrayOf(row, whole, 4 + size);
  return told;
}

/** {values, shape}, numbers with a fraction multiplied out and NaN where there is none. */
function arrayOf(row, whole, start) {
  const count = row.shape.reduce((product, side) => product * side, 1);
  const coded = new TYPES[row.type](whole, start + row.at, count);
  if (!row.scale) return { values: coded, shape: row.shape };
  const values = Float32Array.from(coded, (code) => (code === UNKNOWN ? NaN : code * row.scale));
  return { values, shape: row.shape };
}
