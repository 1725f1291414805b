'use strict';

// Two pictures with a divider between them, and the choice of slot, exposure and pixel.

const kDarkMean = 0.06; // light
const kBrightMean = 1;
const kShownMean = 0.25;
const views = allViews();
const drawing = {a: 0, b: 0}; // numbers of the latest drawings: a slower, older one is dropped
const latest = {}; // side -> promise of the latest drawing

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
  const under = state.layout === 'divider' && state.a !== state.b;
  element('layer-a').style.clipPath = under ? `inset(0 ${100 - state.divider}% 0 0)` : 'none';
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

/** Two pictures that are the same are shown as one. */
function showOneOrTwo() {
  const one = state.a === state.b;
  const beside = state.layout === 'beside' && !one;
  element('name-b').hidden = one;
  element('divider').hidden = one || beside;
  element('stage').classList.toggle('beside', beside);
  element('stage').style.aspectRatio = `${(beside ? 2 : 1) * area.cols} / ${area.rows}`;
  element('layout').value = state.layout;
  element('layout').disabled = one;
  showDivider();
}

function listenToPointer() {
  const divider = element('divider');
  divider.addEventListener('pointerdown', (event) => divider.setPointerCapture(event.pointerId));
  divider.addEventListener('pointermove', (event) => {
    if (divider.hasPointerCapture(event.pointerId)) chooseDivider(placeIn(element('stage'), event).x * 100);
  });
}

function listenToControls() {
  for (const side of ['a', 'b'])
    element(`view-${side}`).addEventListener('change', (event) => choose({[side]: event.target.value}));
  element('slot').addEventListener('input', (event) => chooseSlot(Number(event.target.value)));
  element('layout').addEventListener('change', (event) => choose({layout: event.target.value}));
  element('speed').addEventListener('change', restartPlay);
  element('stops').addEventListener('input', (event) => chooseStops(Number(event.target.value)));
  element('play').addEventListener('click', togglePlay);
}

let playing = null;

function playOn() {
  chooseSlot((state.slot + data.picture_step) % data.slots);
}

function startPlay() {
  const speed = Number(element('speed').value);
  const step = Math.max(1, Math.round(speed / 50)); // a screen has no more pictures than this each second
  playing = setInterval(() => { for (let i = 0; i < step; ++i) playOn(); }, (1000 * step) / speed);
}

function restartPlay() {
  if (!playing) return;
  clearInterval(playing);
  startPlay();
}

function togglePlay() {
  const button = element('play');
  if (button.disabled) return;
  if (playing) playing = clearInterval(playing) ?? null;
  else startPlay();
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
  const slot = data.running_camera ? data.slots - 1 : Math.floor(data.slots / 2);
  return {a: `light-${featured}`, b: `light-${truth ?? Math.max(other, 0)}`, slot};
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
  choose(firstChoice());
  listenToPointer();
  listenToControls();
  setUpDisplay();
  setUpSelection();
  setUpCopies();
  listenToZoom();
  for (const side of ['a', 'b'])
    whenever(['slot', 'stops', 'display', 'low', 'high', side], () => { latest[side] = drawSide(side); });
  whenever(['a', 'b'], showChoice);
  whenever(['a', 'b', 'layout'], showOneOrTwo);
  whenever(['a', 'b', 'stops'], showScale);
  whenever(['divider'], showDivider);
  whenever(['slot'], showSlot);
  whenever(['stops'], showStops);
  firstStops();
}
