'use strict';

// The chosen point: pictures, values, commands.

const kTiles = ['truth', 'naive', 'decoded', 'error'];

function showPictures(row) {
  const box = element('pictures');
  box.style.setProperty('--picture', row.picture ? `url(data:image/png;base64,${row.picture})` : 'none');
  box.replaceChildren(...(row.picture ? kTiles : []).map((name, i) => {
    const tile = made('div', {role: 'img', 'aria-label': name});
    tile.style.backgroundPosition = `${(100 * i) / (kTiles.length - 1)}% 0`;
    return made('figure', {}, tile, made('figcaption', {}, name));
  }));
  element('pictures-hint').textContent = row.picture ?
    `Slot ${Math.floor(row.slots / 2)}, tone-mapped. Error: decoded − truth; mid-grey is none, white 0.25 light too bright, ` +
    'black as much too dark.' : (row.file && `No picture is in this page; it may lie beside it: ${row.file}`);
  if (!row.picture) return;
  const image = new Image();
  image.addEventListener('load', () => {
    for (const tile of box.querySelectorAll('div')) tile.style.aspectRatio = `${image.width / kTiles.length} / ${image.height}`;
    box.dataset.number = row.number; // for tests: it is shown
  });
  image.src = `data:image/png;base64,${row.picture}`;
}

function showPoint() {
  const row = state.point;
  element('point').hidden = row === null;
  if (row === null) return;
  element('point-heading').textContent = `Point ${row.number}`;
  const order = sortedRows();
  const at = order.indexOf(row);
  element('previous').disabled = at <= 0;
  element('next').disabled = at === order.length - 1;
  element('point-place').textContent = nameOf(row);
  const figures = data.columns.map(({name, title}) => [title, columnOf(name).text(row)]);
  if (row.rank) figures.push(['rank', row.rank]);
  if (row.limited_by) figures.push(['rate is limited by', row.limited_by]);
  if (row.compared_slots) figures.push(['slots compared', row.compared_slots]);
  if (data.rungs.length > 1 && row.rung)
    figures.push(['last rung', `${row.rung} of ${data.rungs.length}, ${counted(row.slots, 'slot')}`]);
  const properties = data.axes.map((name, i) => [name, row.values[i]]).filter(([, value]) => value !== '');
  const pairs = [...properties, ...(row.rung ? figures : [])];
  const parts = [termList(pairs, 'settings-grid')];
  if (row.problem) parts.unshift(made('p', {class: 'notes'}, row.problem));
  element('point-values').replaceChildren(...parts);
  element('point-commands').textContent = row.commands;
  showPictures(row);
}

function setUpPoint() {
  element('previous').addEventListener('click', () => movePoint(-1));
  element('next').addEventListener('click', () => movePoint(1));
  whenever(['point', 'sort', 'ranges'], showPoint);
}
