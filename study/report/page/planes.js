'use strict';

// Planes of 16-bit numbers in the page, packed as report/report_page.h says.

const kCacheBytes = 384 * 1024 * 1024;
const planeCache = new Map(); // id -> promise of a Uint16Array; the one used last is the last
let cachedBytes = 0;

function bytesOfBase64(text) {
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Adds up the differences from the value `step` before; the lowest bit of each is its sign. */
function valuesOf(bytes, step) {
  const count = bytes.length / 2;
  const values = new Uint16Array(count);
  for (let i = 0; i < count; ++i) {
    const folded = bytes[i] | (bytes[count + i] << 8);
    const difference = folded & 1 ? -((folded + 1) >> 1) : folded >> 1;
    values[i] = (i < step ? 0 : values[i - step]) + difference;
  }
  return values;
}

async function unpacked(id, step) {
  const text = document.getElementById(id)?.textContent;
  if (text?.startsWith('=')) return plane(text.slice(1), step); // equals that one
  return text ? valuesOf(await inflated(bytesOfBase64(text)), step) : null;
}

/** Each new plane may push out the one that was not used for longest. */
function forgetOldest() {
  if (cachedBytes <= kCacheBytes) return;
  const [id, oldest] = planeCache.entries().next().value;
  planeCache.delete(id);
  oldest.then((values) => { cachedBytes -= values ? values.byteLength : 0; });
}

/** The plane with this id, or null if the page has none. The values of `step` colours take turns in it. */
function plane(id, step = 1) {
  const known = planeCache.get(id) ?? unpacked(id, step).then((values) => {
    cachedBytes += values ? values.byteLength : 0;
    forgetOldest();
    return values;
  });
  planeCache.delete(id);
  planeCache.set(id, known);
  return known;
}
