'use strict';

// What the reader has chosen. Whoever shows it asks to be told of changes.

const state = {slot: 0, stops: 0, divider: 50, a: null, b: null, pixel: null, colour: 0, run: 0, log: false};
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

function chooseSlot(slot) {
  choose({slot: clamp(slot, 0, data.slots - 1)});
}

function chooseStops(stops) {
  choose({stops: clamp(stops, -8, 8)});
}

function chooseDivider(divider) {
  choose({divider: clamp(divider, 0, 100)});
}

function choosePixel(row, col) {
  choose({pixel: {row: clamp(row, 0, area.rows - 1), col: clamp(col, 0, area.cols - 1)}});
}
