'use strict';

// What a stream that grows brings while it is looked at.

const kStatusMs = 500;

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

async function askStatus() {
  const status = await answered('status', {});
  if (!status) return;
  takeSlots(status.slots);
  element('follow-label').hidden = status.complete;
  element('state').textContent = status.complete ? '' : `The stream grows: ${counted(status.slots, 'slot')} so far.`;
  if (!status.complete) setTimeout(askStatus, kStatusMs);
}
