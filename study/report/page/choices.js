'use strict';

// Changes of `state`, which holds what the reader has chosen. Whoever shows it asks to be told of them.

const listeners = [];

/** Calls `act` now and whenever one of `keys` has changed. */
function whenever(keys, act) {
  listeners.push({keys, act});
  act();
}

function choose(change) {
  const changed = Object.keys(change).filter((key) => state[key] !== change[key]);
  Object.assign(state, change);
  for (const {keys, act} of listeners) if (keys.some((key) => changed.includes(key))) act();
}

function clamp(value, low, high) {
  return Math.max(low, Math.min(high, value));
}
