'use strict';

// What a page of `stipple view` asks its server for (view/view_page.h). Pictures of a decoded stream
// come at once, and better ones follow for as long as they are looked at.

const kWaitMs = 20000;
const kBestLevel = 3;
const kChartSlots = 32; // on each side of the shown slot, and moved by as many
const viewer = Array.from(crypto.getRandomValues(new Uint32Array(2)), (word) => word.toString(16)).join('');
const levels = new Map(); // id of a picture -> {level, method}
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
  return new Uint16Array(bytes);
}

async function broughtPlane(id) {
  if (id.startsWith('v')) {
    const codes = await broughtPicture(id, 0).catch(tellFailure);
    if (!codes) planeCache.delete(id); // to be asked for again
    return codes ?? null;
  }
  const response = await fetch(`plane/${id}`).catch(tellFailure);
  return response?.ok ? new Uint16Array(await response.arrayBuffer()) : null;
}

function tellFailure(failure) {
  element('state').textContent = failure instanceof TypeError ? 'The program that serves this page has ended.'
                                                              : failure.message;
  return null;
}

/** Takes better pictures of a decoded video as they come, while this slot is shown. */
async function improve(video) {
  const {slot} = state;
  const id = `v${video}-${slot}`;
  if (improving.has(id)) return;
  improving.add(id);
  while (state.slot === slot && shownVideos().includes(video)) {
    if (!await plane(id) || levels.get(id)?.level >= kBestLevel) break;
    const codes = await broughtPicture(id, levels.get(id).level).catch((failure) => (tellFailure(failure), []));
    if (!codes) continue;
    if (codes.length === 0) break; // the next choice of a slot asks again
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
  const response = await fetch(`${path}?${new URLSearchParams(keys)}`).catch(tellFailure);
  return response?.ok ? response.json() : null;
}

/** Light of a pixel in the pictures of a video that are there, as [slot, light]. */
async function lightOverTime(video, {row, col}, plane) {
  const [first, end] = chartSlots();
  const list = await answered('light', {video, row, col, plane, first, end});
  return (list ?? []).map(([slot, code]) => [slot, lightOfCode[code]]);
}

/** The samples of a pixel in the slots of the charts, by the slot in which they are read. */
async function samplesOverTime(runIndex, pixel, colour) {
  const run = data.runs[runIndex];
  const index = dnIndex(run, pixel, colour);
  if (index < 0) return [];
  const [first, end] = chartSlots();
  const list = await answered('samples', {run: runIndex, row: pixel.row, col: pixel.col, first, end});
  return (list ?? []).map(([slot, kind, dn]) => {
    const exposure = run.samples.exposures[kind];
    const response = responseOf(run, pixel, exposure.light_slots);
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
  return data.runs.map((run, i) => (
    {id: `exposure-${i}`, name: `exposures, ${run.name}`, kind: 'exposure',
     image: (slot) => exposureImage(i, slot)}));
}
