'use strict';

// A running camera: its frames and losses, its recording and its features, and where it is in focus.

const kCameraMs = 500;
const kReadMs = 5000; // for a text
const kShownFeatures = 200;
const kFullScale = 0.998; // light: the code of 1 is within 0.27 %
const kFocusPart = 0.02; // of the pixels, those with the strongest edges
let features = [];
let sensor = null; // of the last status

async function act(what, keys = {}) {
  const response = await fetch(`camera/${what}?${new URLSearchParams(keys)}`, {method: 'POST'}).catch(tellFailure);
  if (!response) return null;
  return response.ok ? {camera: await response.json()} : {failure: await response.text()};
}

function lossText(lost) {
  const causes = Object.entries(lost).filter(([, count]) => count > 0);
  return causes.length ? causes.map(([cause, count]) => `${count} ${cause.replaceAll('_', ' ')}`).join(', ') : 'none';
}

function showCamera(camera) {
  const {recording} = camera;
  const rate = camera.frames_hz ? `, ${shown(camera.frames_hz)} per second` : '';
  const further = [[camera.incomplete, 'incomplete'], [camera.outages, 'outages'],
                   [camera.skipped, 'not shown, as the emulation was too slow']];
  element('camera-frames').textContent = [`${counted(camera.frames, 'frame')}${rate}; lost: ${lossText(camera.lost)}`,
    ...further.filter(([count]) => count > 0).map(([count, text]) => `${count} ${text}`)].join('; ');
  element('record').textContent = recording ? '■ stop' : '● record';
  element('record').setAttribute('aria-pressed', recording !== null);
  element('record').hidden = recording?.stop === false;
  element('recording').textContent = recording
    ? `${recording.file}: ${counted(recording.frames, 'frame')}, ${recording.lost} lost` : '';
  showSensor(camera.sensor);
  element('camera-events').hidden = camera.events.length === 0;
  element('camera-events').replaceChildren(...camera.events.slice(-8).reverse().map(({seconds, text}) => (
    made('li', {}, `${shown(seconds)} s: ${text}`))));
  if (camera.ended) element('state').textContent = `The camera has ended: ${camera.ended}`;
}

/** What is running, unless it is just being changed. */
function showSensor(now) {
  if (JSON.stringify(now) === JSON.stringify(sensor)) return;
  sensor = now;
  const names = [...new Set([sensor.schedule, ...data.schedules])];
  fillSelect(element('sensor-schedule'), names.map((value) => ({value, text: value})), sensor.schedule);
  element('sensor-seed').value = sensor.seed;
  if (sensor.fixed) element('sensor-answer').textContent = `It cannot change: ${sensor.fixed}.`;
  for (const input of element('sensor-form').elements) input.disabled = sensor.fixed !== null;
}

/** Between two slots; the stream says from which one on. */
async function changeSensor(event) {
  event.preventDefault();
  const chosen = {schedule: element('sensor-schedule').value, seed: element('sensor-seed').value};
  const changes = Object.entries(chosen).filter(([key, value]) => value !== String(sensor[key]))
    .map(([key, value]) => `${key}=${value}`);
  changes.push(...element('sensor-keys').value.split(/\s+/).filter(Boolean));
  if (changes.length === 0) return;
  element('sensor-answer').textContent = 'setting up …';
  const answer = await act('sensor', {changes: changes.join(',')});
  element('sensor-answer').textContent = answer?.failure ?? changes.join(', ');
  if (answer?.camera) showCamera(answer.camera);
}

async function askCamera() {
  const camera = await answered('camera', {});
  if (!camera) return;
  showCamera(camera);
  if (!camera.ended) setTimeout(askCamera, kCameraMs);
}

async function toggleRecording() {
  const recording = element('record').getAttribute('aria-pressed') === 'true';
  const answer = await act(recording ? 'stop' : 'record');
  if (answer?.camera) showCamera(answer.camera);
  if (answer?.failure) element('recording').textContent = answer.failure;
}

/** Features that are locked while frames come are set by opening the camera anew. */
async function setFeature({name, locked}, value) {
  element('feature-answer').textContent = locked ? `${name}: opening the camera anew …` : '';
  leaving = locked;
  const answer = await act('set', {feature: name, value, ...(locked ? {stopped: 1} : {})});
  if (answer?.camera?.reload) return location.reload();
  element('feature-answer').textContent = answer?.failure ?? `${name} = ${value}`;
  if (leaving) return setTimeout(() => location.reload(), kReadMs); // the loops that ask have ended
  return readFeatures();
}

/** What a feature takes its value from. */
function featureInput(feature) {
  if (feature.access !== 'rw' && !feature.locked) return feature.value ?? '';
  const choices = feature.type === 'boolean' ? ['true', 'false'] : feature.choices;
  const input = choices.length ? made('select', {'aria-label': feature.name})
    : made('input', {'aria-label': feature.name, type: 'text', value: feature.value ?? ''});
  if (choices.length) fillSelect(input, choices.map((value) => ({value, text: value})), feature.value);
  input.addEventListener('change', () => setFeature(feature, input.value));
  return input;
}

function featureRange({minimum, maximum, increment, unit}) {
  const range = minimum === null && maximum === null ? '' : `${minimum ?? ''}..${maximum ?? ''}`;
  return [range, increment && increment !== '1' ? `step ${increment}` : '', unit].filter(Boolean).join(' ');
}

function showFeatures() {
  const part = element('feature-filter').value.toLowerCase();
  const found = features.filter(({name}) => name.toLowerCase().includes(part)).slice(0, kShownFeatures);
  fillTable(element('features-table'), [['feature', 'value'],
    ...found.map((feature) => [made('span', {}, feature.name, made('small', {}, featureRange(feature))),
                               featureInput(feature)])]);
}

async function readFeatures() {
  const all = await answered('camera/features', {}) ?? features;
  features = all.filter(({type, value}) => type !== 'command' && type !== 'register' && value !== null);
  showFeatures();
}

/** Of the light of a picture: the pixels at full scale, and those without light. */
async function showClipping() {
  const codes = await picture(0, state.slot);
  if (!codes) return;
  const full = codeOfLight(kFullScale);
  const part = (is) => `${shown((100 * codes.reduce((sum, code) => sum + is(code), 0)) / codes.length, 2)} %`;
  element('camera-clipping').textContent =
    `Slot ${state.slot}: ${part((code) => code >= full)} at full scale, ${part((code) => code === 0)} black.`;
}

/** Edges in focus are green, pixels at full scale red. */
async function focusImage(slot) {
  const codes = await picture(0, slot);
  const image = codes && await lightImage(0, slot);
  if (!image) return null;
  const light = Float32Array.from({length: pixelCount}, (_, i) => luminanceAt(codes, i));
  const edges = new Float32Array(pixelCount);
  for (let row = 1; row < area.rows - 1; ++row)
    for (let i = row * area.cols + 1; i < (row + 1) * area.cols - 1; ++i)
      edges[i] = Math.abs(4 * light[i] - light[i - 1] - light[i + 1] - light[i - area.cols] - light[i + area.cols]);
  const least = Math.max(quantile(edges.slice().sort(), 1 - kFocusPart), 1e-6);
  const full = codeOfLight(kFullScale);
  for (let i = 0; i < pixelCount; ++i) {
    if (edges[i] >= least) image.data.set([40, 255, 60], 4 * i);
    if (codes[i] >= full) image.data.set([255, 30, 30], 4 * i);
  }
  return image;
}

function setUpCamera() {
  if (!data.running_camera) return;
  element('camera-card').hidden = false;
  element('record').addEventListener('click', toggleRecording);
  element('sensor-form').addEventListener('submit', changeSensor);
  element('features').addEventListener('toggle', () => { if (element('features').open) readFeatures(); });
  element('features-again').addEventListener('click', readFeatures);
  element('feature-filter').addEventListener('input', showFeatures);
  setInterval(showClipping, kCameraMs);
  askCamera();
}
