'use strict';

// Keys.

/** Whether an element takes this key for itself. */
function takesKeys(target, key) {
  if (target.matches('select, textarea, input[type=text], input[type=number]')) return true;
  if (target.matches('button, summary, input[type=checkbox]')) return key === ' ' || key === 'Enter';
  return target.matches('input[type=range]') && /^(Arrow|Home|End|Page)/.test(key);
}

function movePixel(key) {
  const {row, col} = state.pixel;
  const [down, right] = {ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1]}[key];
  choosePixel(row + down, col + right);
}

/** Key -> what it does, in words and in fact. */
const kKeys = {
  ArrowLeft: ['← →', 'slot', () => chooseSlot(state.slot - 1)],
  ArrowRight: ['', '', () => chooseSlot(state.slot + 1)],
  PageUp: ['Page Up, Down', 'ten slots', () => chooseSlot(state.slot - 10)],
  PageDown: ['', '', () => chooseSlot(state.slot + 10)],
  Home: ['Home, End', 'first, last slot', () => chooseSlot(data.first ?? 0)],
  End: ['', '', () => chooseSlot(data.slots - 1)],
  ' ': ['Space', 'play', togglePlay],
  z: ['z, x, 0', 'zoom in, out, whole picture', () => chooseZoom(state.zoom.scale * 1.5)],
  x: ['', '', () => chooseZoom(state.zoom.scale / 1.5)],
  0: ['', '', () => chooseZoom(1)],
  '[': ['[ ]', 'divider', () => chooseDivider(state.divider - 5)],
  ']': ['', '', () => chooseDivider(state.divider + 5)],
  s: ['s', 'side by side, or under a divider', () => choose({layout: state.layout === 'beside' ? 'divider' : 'beside'})],
  '+': ['+ −', 'exposure', () => chooseStops(state.stops + 0.5)],
  '=': ['', '', () => chooseStops(state.stops + 0.5)],
  '-': ['', '', () => chooseStops(state.stops - 0.5)],
  d: ['d', 'next display', () => chooseNextDisplay()],
  l: ['l', 'limits from the picture', () => limitsOfPicture()],
  p: ['p', 'PNG of the left picture', () => savePicture()],
  Escape: ['Esc', 'without region and line', () => choose({region: null, line: null})],
  '?': ['?', 'these keys', () => element('help').showModal()],
};

function chooseNextDisplay() {
  const names = Object.keys(kDisplays);
  choose({display: names[(names.indexOf(state.display) + 1) % names.length]});
}

function setUpKeys() {
  const rows = [['Shift ← →', 'pixel'], ['click', 'pixel'], ['Shift and drag', 'region'], ['Alt and drag', 'line'],
                ['Ctrl and wheel, double click', 'zoom'],
                ...Object.values(kKeys).filter(([keys]) => keys).map(([keys, text]) => [keys, text])];
  fillTable(element('help-table'), [['key', ''], ...rows]);
  element('help-close').addEventListener('click', () => element('help').close());
  document.addEventListener('keydown', takeKey);
}

function dividerKey(key) {
  const step = {ArrowLeft: -2, ArrowRight: 2, Home: -100, End: 100}[key];
  if (step) chooseDivider(state.divider + step);
  return step !== undefined;
}

function takeKey(event) {
  if (event.ctrlKey || event.altKey || event.metaKey || element('help').open || takesKeys(event.target, event.key)) return;
  const arrow = event.key.startsWith('Arrow');
  if (event.shiftKey && arrow) movePixel(event.key);
  else if (event.target.id === 'divider' && dividerKey(event.key)) { /* done */ }
  else if (kKeys[event.key]) kKeys[event.key][2]();
  else return;
  event.preventDefault();
}
