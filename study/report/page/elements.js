'use strict';

// Elements of the page. Texts of files become text nodes, never markup.

const kOtherColours = 5; // series-2 to series-6 of the style

function element(id) {
  return document.getElementById(id);
}

/** A new element with attributes and children (elements or texts). */
function made(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}

/** The same for a drawing. */
function drawn(name, attributes = {}, ...children) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}

function fillSelect(select, options, chosen) {
  select.replaceChildren(...options.map(({value, text}) => made('option', {value}, text)));
  select.value = chosen;
}

/** Rows of cells; the first row is the head. A cell is a text, an element or {text, best}. */
function fillTable(table, rows) {
  const cell = (tag, content) => {
    const node = made(tag);
    node.append(content?.best === undefined ? content : content.text);
    if (content?.best) node.className = 'best';
    return node;
  };
  table.replaceChildren(...rows.map((row, i) => made('tr', {}, ...row.map((c) => cell(i === 0 ? 'th' : 'td', c)))));
}

/** A list of names and values. */
function termList(pairs, className) {
  return made('dl', {class: className}, ...pairs.map(([name, value]) => (
    made('div', {}, made('dt', {}, name), made('dd', {}, String(value))))));
}

/** About four digits, for people. */
function shown(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return '–';
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e7)) return value.toExponential(digits - 1);
  return Number(value.toPrecision(Math.max(digits, Math.ceil(Math.log10(size + 1))))).toString();
}

function counted(count, noun) {
  return `${count} ${noun}${count === 1 ? '' : 's'}`;
}

/** A colour of the style sheet. */
function styleColour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** The place of a video among those that are neither the truth nor featured; -1 of these. */
function placeOfVideo(video) {
  const others = data.videos.map((_, i) => i).filter((i) => i !== data.truth && i !== data.featured);
  return others.indexOf(video);
}

/** The colour of a video in all charts. */
function videoColour(video) {
  if (video === data.truth) return styleColour('truth');
  if (video === data.featured) return styleColour('series-1');
  return styleColour(`series-${2 + (placeOfVideo(video) % kOtherColours)}`);
}

/** The dashes of its line: where colours repeat, lines differ. */
function videoDash(video) {
  const turn = Math.floor(Math.max(placeOfVideo(video), 0) / kOtherColours);
  return [[], [6, 3], [2, 3]][turn % 3];
}
