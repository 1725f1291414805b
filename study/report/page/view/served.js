'use strict';

// What a page of `stipple view` asks its server for (view/view_page.h). Pictures of a decoded stream
// come at once, and better ones follow for as long as they are looked at.

const kWaitMs = 20000;
const kBestLevel = 3;
const kChartSlots = 32; // on each side of the shown slot, and moved by as many
const viewer = Array.from(crypto.getRandomValues(new Uint32Array(2)), (word) => word.toString(16)).join('');
const levels = new Map(); // id of a picture -> {level, method}
const ages = new Map(); // id of a picture of a camera -> when its light came, as performance.now()
let leaving = false; // the program has ended, or the page begins anew: it asks for nothing more
const improving = new Set(); // ids of pictures that better ones are awaited for

function isDecoded(video) {
  return data.videos[video]?.run !== null;
}

/** The picture of a video as codes; null if there is no better one, or another slot was chosen. */
async function broughtPicture(id, than) {
  const response = await fetch(`plane/${id}?viewer=${viewer}&than=${than}&wait=${kWaitMs}`);
  if (!response.ok) throw new Error(await response.text());
  const bytes = await response.arrayBuffer();
  if (bytes.byteLength === 0) return null;
  const level = Number(response.headers.get('Stipple-Level') ?? kBestLevel);
  levels.set(id, {level, method: response.headers.get('Stipple-Method') ?? ''});
  if (response.headers.has('Stipple-Age-Ms')) ages.set(id, performance.now() - Number(response.headers.get('Stipple-Age-Ms')));
  return new Uint16Array(bytes);
}

async function broughtPlane(id) {
  if (leaving) return null;
  if (id.startsWith('v')) {
    const codes = await broughtPicture(id, 0).catch(tellFailure);
    if (!codes) planeCache.delete(id); // to be asked for again
    return codes ?? null;
  }
  const response = await fetch(`plane/${id}`).catch(tellFailure);
  const values = response?.ok ? new Uint16Array(await response.arrayBuffer()) : [];
  const run = Number(id.match(/^r(\d+)k-/)?.[1] ?? -1);
  if (run >= 0 && values.some((kind) => kind > data.runs[run].samples.exposures.length)) await readRun(run);
  return values.length > 0 ? values : null;
}

function tellFailure(failure) {
  if (failure instanceof TypeError) leaving = true;
  element('state').textContent = leaving ? 'The program that serves this page has ended.' : failure.message;
  return null;
}

/** Takes better pictures of a decoded video as they come, while this slot is shown. */
async function improve(video) {
  const {slot} = state;
  const id = `v${video}-${slot}`;
  if (improving.has(id)) return;
  improving.add(id);
  while (!leaving && state.slot === slot && shownVideos().includes(video)) {
    if (!await plane(id) || levels.get(id)?.level >= kBestLevel) break;
    let failed = false;
    const codes = await broughtPicture(id, levels.get(id).level).catch((failure) => {
      failed = true;
      return tellFailure(failure);
    });
    if (failed) break;
    if (!codes) continue;
    planeCache.set(id, Promise.resolve(codes));
    choose({pictures: state.pictures + 1});
  }
  improving.delete(id);
}

/** The decoded videos that are looked at. */
function shownVideos() {
  const of = (side) => state[side]?.match(/^(?:light|error)-(\d+)$/);
  return ['a', 'b'].map(of).filter(Boolean).map((found) => Number(found[1])).filter(isDecoded);
}

function pictureNote(view, slot) {
  const video = view.id.match(/^(?:light|error)-(\d+)$/)?.[1];
  const found = video && levels.get(`v${video}-${slot}`);
  if (!found?.method) return '';
  return `, ${found.method}${found.level < kBestLevel ? ' …' : ''}`;
}

function chartSlots() {
  const middle = Math.floor(state.slot / kChartSlots) * kChartSlots + kChartSlots / 2;
  const first = Math.max(0, middle - kChartSlots);
  return [first, Math.max(Math.min(data.slots, first + 2 * kChartSlots), first + 1)];
}

async function answered(path, keys) {
  if (leaving) return null;
  const response = await fetch(`${path}?${new URLSearchParams(keys)}`).catch(tellFailure);
  return response?.ok ? response.json() : null;
}

/** Reads a run again: a switch of its schedule brings other exposures. */
async function readRun(index) {
  const run = await answered('run', {run: index});
  if (!run) return;
  data.runs[index] = run;
  showScheduleText();
  showSchedule();
}

/** `switched` is that of the status (view/view_page.h). */
async function takeSwitches(switched) {
  for (const [i, slot] of switched.entries())
    if (slot !== (data.runs[i].stream.switches?.at(-1)?.slot ?? 0)) await readRun(i);
}

/** Light of a pixel in the pictures of a video that are there, as [slot, light]. */
async function lightOverTime(video, {row, col}, plane) {
  const [first, end] = chartSlots();
  const list = await answered('light', {video, row, col, plane, first, end});
  return (list ?? []).map(([slot, code]) => [slot, lightOfCode[code]]);
}

/** The samples of a pixel in the slots of the charts, by the slot in which they are read. */
async function samplesOverTime(runIndex, pixel, colour) {
  const index = dnIndex(data.runs[runIndex], pixel, colour);
  if (index < 0) return [];
  const [first, end] = chartSlots();
  const list = await answered('samples', {run: runIndex, row: pixel.row, col: pixel.col, first, end});
  if (list?.some(([, kind]) => kind >= data.runs[runIndex].samples.exposures.length)) await readRun(runIndex);
  const run = data.runs[runIndex];
  return (list ?? []).map(([slot, kind, dn]) => {
    const exposure = run.samples.exposures[kind];
    const response = responseOf(run, pixel, exposure);
    return {first: slot - exposure.span_slots + 1, slot, exposure,
            ...lightOfSample(response, dn[index], exposure.light_slots)};
  });
}

/** By pixel the length of the exposure under way. */
async function exposureImage(runIndex, slot) {
  const lengths = await plane(`r${runIndex}e-${slot}`);
  if (!lengths) return null;
  const colours = new Map([...lengthColours(data.runs[runIndex])].map(([length, hex]) => (
    [length, [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16))])));
  const image = new ImageData(area.cols, area.rows);
  for (let i = 0; i < pixelCount; ++i)
    image.data.set([...(colours.get(lengths[i]) ?? kNoSample), 255], 4 * i);
  return image;
}

function furtherViews() {
  const exposures = data.runs.map((run, i) => (
    {id: `exposure-${i}`, name: `exposures, ${run.name}`, kind: 'exposure',
     image: (slot) => exposureImage(i, slot)}));
  const focus = {id: 'focus', name: 'camera, focus and clipping', kind: 'light', image: focusImage,
                 codes: (slot) => picture(0, slot)};
  return data.running_camera ? [focus, ...exposures] : exposures;
}
