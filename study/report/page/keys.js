'use strict';

// Keys.

/** Whether an element takes this key for itself. */
function takesKeys(target, key) {
  if (target.matches('select, textarea, input[type=text]')) return true;
  if (target.matches('button, summary, input[type=checkbox]')) return key === ' ' || key === 'Enter';
  return target.matches('input[type=range]') && /^(Arrow|Home|End|Page)/.test(key);
}

function movePixel(key) {
  const {row, col} = state.pixel;
  const [down, right] = {ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1]}[key];
  choosePixel(row + down, col + right);
}

const kKeys = {
  ArrowLeft: () => chooseSlot(state.slot - 1),
  ArrowRight: () => chooseSlot(state.slot + 1),
  Home: () => chooseSlot(0),
  End: () => chooseSlot(data.slots - 1),
  '+': () => chooseStops(state.stops + 0.5),
  '=': () => chooseStops(state.stops + 0.5),
  '-': () => chooseStops(state.stops - 0.5),
  '[': () => chooseDivider(state.divider - 5),
  ']': () => chooseDivider(state.divider + 5),
  ' ': togglePlay,
};

function dividerKey(key) {
  const step = {ArrowLeft: -2, ArrowRight: 2, Home: -100, End: 100}[key];
  if (step) chooseDivider(state.divider + step);
  return step !== undefined;
}

function takeKey(event) {
  if (event.ctrlKey || event.altKey || event.metaKey || takesKeys(event.target, event.key)) return;
  const arrow = event.key.startsWith('Arrow');
  if (event.shiftKey && arrow) movePixel(event.key);
  else if (event.target.id === 'divider' && dividerKey(event.key)) { /* done */ }
  else if (kKeys[event.key]) kKeys[event.key]();
  else return;
  event.preventDefault();
}
