'use strict';

// Two pictures with a divider between them, and the choice of slot, exposure and pixel.

const kDarkMean = 0.06; // light
const kBrightMean = 1;
const kShownMean = 0.25;
const views = allViews();
const drawing = {a: 0, b: 0}; // numbers of the latest drawings: a slower, older one is dropped

function viewOf(side) {
  return views.find((view) => view.id === state[side]);
}

async function drawSide(side) {
  const number = ++drawing[side];
  const view = viewOf(side);
  const image = await view.image(state.slot, state.stops);
  if (number !== drawing[side]) return;
  const context = element(`picture-${side}`).getContext('2d', {willReadFrequently: true});
  context.fillStyle = `rgb(${kNoSample.join()})`;
  if (image) context.putImageData(image, 0, 0);
  else context.fillRect(0, 0, area.cols, area.rows); // such as after the end of the truth
  element(`name-${side}`).textContent = image ? view.name + pictureNote(view, state.slot)
                                              : `${view.name}: no picture of this slot`;
  element(`picture-${side}`).dataset.slot = state.slot;
}

function showChoice() {
  for (const side of ['a', 'b']) element(`view-${side}`).value = state[side];
}

function showScale() {
  const range = shown(kErrorRange / 2 ** state.stops, 2);
  element('scale').hidden = viewOf('a').kind !== 'error' && viewOf('b').kind !== 'error';
  element('scale-low').textContent = `−${range} light, too dark`;
  element('scale-high').textContent = `too bright, +${range} light`;
}

function showDivider() {
  const divider = element('divider');
  divider.style.left = `${state.divider}%`;
  divider.setAttribute('aria-valuenow', Math.round(state.divider));
  divider.setAttribute('aria-valuetext', `${Math.round(state.divider)} % left picture`);
  element('picture-a').style.clipPath = `inset(0 ${100 - state.divider}% 0 0)`;
}

function showSlot() {
  element('slot').value = state.slot;
  const time = data.runs.length ? `, ${shown((state.slot * data.runs[0].stream.slot_us) / 1000)} ms` : '';
  element('slot-text').textContent = `${state.slot} of ${data.slots}${time}`;
}

function showStops() {
  element('stops').value = state.stops;
  element('stops-text').textContent = `${state.stops > 0 ? '+' : ''}${state.stops} stops`;
}

function showCrosshair() {
  const cross = element('crosshair');
  cross.hidden = !state.pixel;
  if (!state.pixel) return;
  const size = Math.max(100 / area.cols, 1.6);
  cross.style.width = `${size}%`;
  cross.style.height = `${(size * area.cols) / area.rows}%`;
  cross.style.left = `${((state.pixel.col + 0.5) / area.cols) * 100 - size / 2}%`;
  cross.style.top = `${((state.pixel.row + 0.5) / area.rows) * 100 - (size * area.cols) / area.rows / 2}%`;
}

/** Two pictures that are the same are shown as one. */
function showOneOrTwo() {
  const one = state.a === state.b;
  element('name-b').hidden = one;
  element('divider').hidden = one;
  element('divider-keys').hidden = one;
}

/** Place of a pointer in the stage, as fractions of its sides. */
function placeOf(event) {
  const box = element('stage').getBoundingClientRect();
  return {x: (event.clientX - box.left) / box.width, y: (event.clientY - box.top) / box.height};
}

function listenToPointer() {
  const divider = element('divider');
  divider.addEventListener('pointerdown', (event) => divider.setPointerCapture(event.pointerId));
  divider.addEventListener('pointermove', (event) => {
    if (divider.hasPointerCapture(event.pointerId)) chooseDivider(placeOf(event).x * 100);
  });
  element('stage').addEventListener('click', (event) => {
    if (divider.contains(event.target)) return;
    const {x, y} = placeOf(event);
    choosePixel(Math.floor(y * area.rows), Math.floor(x * area.cols));
  });
}

function listenToControls() {
  for (const side of ['a', 'b'])
    element(`view-${side}`).addEventListener('change', (event) => choose({[side]: event.target.value}));
  element('slot').addEventListener('input', (event) => chooseSlot(Number(event.target.value)));
  element('stops').addEventListener('input', (event) => chooseStops(Number(event.target.value)));
  element('play').addEventListener('click', togglePlay);
}

let playing = null;

function togglePlay() {
  const button = element('play');
  if (button.disabled) return;
  if (playing) clearInterval(playing);
  playing = playing ? null : setInterval(() => chooseSlot((state.slot + data.picture_step) % data.slots), 100);
  button.setAttribute('aria-pressed', playing !== null);
  button.setAttribute('aria-label', playing ? 'pause' : 'play');
  button.textContent = playing ? '❚❚' : '▶';
}

/** Exposure at which the mean light of a picture is shown as a grey: 0, unless it is very dark or bright. */
async function firstStops() {
  const codes = await picture(data.featured, pictureSlot(state.slot));
  if (!codes) return;
  const mean = codes.reduce((sum, code) => sum + lightOfCode[code], 0) / codes.length;
  if (state.stops === 0 && mean > 0 && (mean < kDarkMean || mean > kBrightMean)) chooseStops(Math.round(Math.log2(kShownMean / mean)));
}

/** The featured video beside the truth or, without one, beside another video. */
function firstChoice() {
  const {featured, truth} = data;
  const other = data.videos.findIndex((_, i) => i !== truth && i !== featured);
  return {a: `light-${featured}`, b: `light-${truth ?? Math.max(other, 0)}`, slot: Math.floor(data.slots / 2)};
}

function setUpViewer() {
  if (data.videos.length === 0) return;
  element('viewer').hidden = false;
  for (const side of ['a', 'b']) {
    Object.assign(element(`picture-${side}`), {width: area.cols, height: area.rows});
    fillSelect(element(`view-${side}`), views.map((view) => ({value: view.id, text: view.name})));
  }
  element('slot').max = data.slots - 1;
  element('slot').disabled = data.slots === 1;
  element('play').disabled = data.slots <= data.picture_step; // a single picture
  element('slot-keys').hidden = data.slots === 1;
  choose(firstChoice());
  listenToPointer();
  listenToControls();
  whenever(['slot', 'stops', 'a'], () => drawSide('a'));
  whenever(['slot', 'stops', 'b'], () => drawSide('b'));
  whenever(['a', 'b'], showChoice);
  whenever(['a', 'b'], showOneOrTwo);
  whenever(['a', 'b', 'stops'], showScale);
  whenever(['divider'], showDivider);
  whenever(['slot'], showSlot);
  whenever(['stops'], showStops);
  whenever(['pixel'], showCrosshair);
  firstStops();
}
