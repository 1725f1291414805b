'use strict';

// Planes of 16-bit numbers in the page, packed as apps/run_report/plane_code.h says.

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

/** Adds up the differences; the lowest bit of each is its sign. */
function valuesOf(bytes) {
  const count = bytes.length / 2;
  const values = new Uint16Array(count);
  let value = 0;
  for (let i = 0; i < count; ++i) {
    const folded = bytes[i] | (bytes[count + i] << 8);
    value += folded & 1 ? -((folded + 1) >> 1) : folded >> 1;
    values[i] = value;
  }
  return values;
}

async function unpacked(id) {
  const text = document.getElementById(id)?.textContent;
  if (text?.startsWith('=')) return plane(text.slice(1)); // equals that one
  return text ? valuesOf(await inflated(bytesOfBase64(text))) : null;
}

/** Each new plane may push out the one that was not used for longest. */
function forgetOldest() {
  if (cachedBytes <= kCacheBytes) return;
  const [id, oldest] = planeCache.entries().next().value;
  planeCache.delete(id);
  oldest.then((values) => { cachedBytes -= values ? values.byteLength : 0; });
}

/** The plane with this id, or null if the page has none. */
function plane(id) {
  const known = planeCache.get(id) ?? unpacked(id).then((values) => {
    cachedBytes += values ? values.byteLength : 0;
    forgetOldest();
    return values;
  });
  planeCache.delete(id);
  planeCache.set(id, known);
  return known;
}
