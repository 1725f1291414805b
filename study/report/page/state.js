'use strict';

// What the reader has chosen.

const state = {slot: 0, stops: 0, divider: 50, a: null, b: null, pixel: null, colour: 0, run: 0, log: false,
               layout: 'divider', zoom: {scale: 1, left: 0, top: 0}, tool: 'pixel', region: null, line: null,
               display: 'tone', low: 0, high: 1, pictures: 0};

function chooseSlot(slot) {
  choose({slot: clamp(slot, data.first ?? 0, data.slots - 1)});
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
