'use strict';

// Zoom and pan. state.zoom has the scale and what lies at the corner, as fractions of the picture's sides.

const kLeastShown = 8; // pixels across at the largest scale

/** Zooms so that the place `at` of the stage, fractions of its sides, keeps its pixel. */
function chooseZoom(wanted, at = {x: 0.5, y: 0.5}) {
  const {zoom} = state;
  const scale = clamp(wanted, 1, Math.max(1, Math.min(area.rows, area.cols) / kLeastShown));
  const corner = (from, place) => clamp(from + place * (1 / zoom.scale - 1 / scale), 0, 1 - 1 / scale);
  choose({zoom: {scale, left: corner(zoom.left, at.x), top: corner(zoom.top, at.y)}});
}

/** Moves the picture by fractions of the stage. */
function pan(right, down) {
  const {scale, left, top} = state.zoom;
  const corner = (from, by) => clamp(from - by / scale, 0, 1 - 1 / scale);
  choose({zoom: {scale, left: corner(left, right), top: corner(top, down)}});
}

/** The layer of a picture under a pointer: one, or the left or the right one. */
function layerAt(event) {
  const beside = state.layout === 'beside' && !element('layer-a').hidden;
  const box = element('stage').getBoundingClientRect();
  return element(beside && event.clientX < box.left + box.width / 2 ? 'layer-a' : 'layer-b');
}

/** Place of a pointer in a layer, as fractions of its sides. */
function placeIn(layer, event) {
  const box = layer.getBoundingClientRect();
  return {x: (event.clientX - box.left) / box.width, y: (event.clientY - box.top) / box.height};
}

/** The pixel under a place of the stage. */
function pixelAt({x, y}) {
  const {scale, left, top} = state.zoom;
  return {row: clamp(Math.floor((top + y / scale) * area.rows), 0, area.rows - 1),
          col: clamp(Math.floor((left + x / scale) * area.cols), 0, area.cols - 1)};
}

function showZoom() {
  const {scale, left, top} = state.zoom;
  for (const side of ['a', 'b']) {
    element(`picture-${side}`).style.transform = `translate(${-left * scale * 100}%, ${-top * scale * 100}%) scale(${scale})`;
    element(`marks-${side}`).setAttribute('viewBox', [left * area.cols, top * area.rows,
                                                      area.cols / scale, area.rows / scale].join(' '));
  }
  element('stage').classList.toggle('zoomed', scale > 1);
  element('zoom-text').textContent = scale > 1 ? `${shown(scale, 2)} ×` : '';
}

/** A double click, Ctrl and the wheel, or two fingers on a touch pad zoom. */
function listenToZoom() {
  const stage = element('stage');
  stage.addEventListener('wheel', (event) => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    chooseZoom(state.zoom.scale * 2 ** (-event.deltaY / 200), placeIn(layerAt(event), event));
  }, {passive: false});
  stage.addEventListener('dblclick', (event) => chooseZoom(state.zoom.scale * 2, placeIn(layerAt(event), event)));
  whenever(['zoom'], showZoom);
}
