'use strict';

// Planes of 16-bit numbers. Those that were used last are kept; embedded.js or served.js brings the others.

const kCacheBytes = 384 * 1024 * 1024;
const planeCache = new Map(); // id -> promise of a Uint16Array; the one used last is the last
let cachedBytes = 0;

/** Each new plane may push out the one that was not used for longest. */
function forgetOldest() {
  if (cachedBytes <= kCacheBytes) return;
  const [id, oldest] = planeCache.entries().next().value;
  planeCache.delete(id);
  oldest.then((values) => { cachedBytes -= values ? values.byteLength : 0; });
}

/** The plane with this id, or null if there is none. The values of `step` colours take turns in it. */
function plane(id, step = 1) {
  const known = planeCache.get(id) ?? broughtPlane(id, step).then((values) => {
    cachedBytes += values ? values.byteLength : 0;
    forgetOldest();
    return values;
  });
  planeCache.delete(id);
  planeCache.set(id, known);
  return known;
}
