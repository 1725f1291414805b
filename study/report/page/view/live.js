'use strict';

// What a stream that grows, or a running camera, brings while it is looked at.

const kStatusMs = 500;
const kDecodedBehind = 16; // slots: what comes after a slot tells of it too
let followed = null; // the slot of a camera that was shown as the newest one

function takeSlots(slots) {
  if (slots === data.slots) return;
  const atEnd = state.slot === data.slots - 1;
  data.slots = slots;
  element('slot').max = slots - 1;
  element('slot').disabled = slots === 1;
  element('play').disabled = slots === 1;
  if (atEnd && element('follow').checked) chooseSlot(slots - 1);
  showSlot();
}

const shownAt = []; // of the last pictures, ms

/** From the arrival of the frame to its picture on the screen. */
function showLatency() {
  const now = performance.now();
  shownAt.push(now);
  if (shownAt.length > 30) shownAt.shift();
  const videos = shownVideos();
  const arrival = ages.get(`v${videos.length ? videos[0] : 0}-${state.slot}`);
  if (!arrival) return;
  const rate = (1000 * (shownAt.length - 1)) / (now - shownAt[0]);
  element('state').textContent = `${shown(now - arrival, 3)} ms after its light, ${shown(rate, 2)} pictures per second`;
  ages.clear();
}

/** The newest slots of a camera, as fast as they can be shown. */
async function followCamera() {
  for (let slots = -1; ;) {
    const status = await answered('status', {than: slots, wait: 1000});
    if (!status) return;
    ({slots} = status);
    Object.assign(data, {slots, first: status.first});
    await takeSwitches(status.switched);
    Object.assign(element('slot'), {min: status.first, max: slots - 1, disabled: slots === 1});
    element('play').disabled = slots === 1;
    if (followed !== null && state.slot !== followed) {
      element('follow').checked = false;
      showLanes();
    }
    followed = null;
    if (element('follow').checked) {
      chooseSlot(slots - 1 - (shownVideos().length ? kDecodedBehind : 0));
      followed = state.slot;
      await Promise.all(Object.values(latest));
      showLatency();
    }
    showSlot();
    if (status.complete) return;
    await new Promise((resolve) => { setTimeout(resolve, 20); });
  }
}

async function askStatus() {
  if (data.running_camera) {
    element('follow-label').hidden = false;
    return followCamera();
  }
  const status = await answered('status', {});
  if (!status) return;
  takeSlots(status.slots);
  await takeSwitches(status.switched);
  element('follow-label').hidden = status.complete;
  element('state').textContent = status.complete ? '' : `The stream grows: ${counted(status.slots, 'slot')} so far.`;
  if (!status.complete) setTimeout(askStatus, kStatusMs);
}
