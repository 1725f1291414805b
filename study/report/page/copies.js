'use strict';

// What can be taken along: a picture as PNG, samples and profiles as CSV, the command of the page.

function download(name, blob) {
  const link = made('a', {href: URL.createObjectURL(blob), download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

function savePicture() {
  const name = viewOf('a').name.replace(/[^\w.-]+/g, '_');
  element('picture-a').toBlob((blob) => download(`${name}_slot${state.slot}.png`, blob));
}

/** The rows of a table as CSV: texts that a spreadsheet would take for a formula are quoted. */
function csvOf(table) {
  const cell = (text) => {
    const safe = /^[=+@-][^\d]/.test(text) ? `'${text}` : text;
    return /[",\n]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
  };
  return [...table.rows].map((row) => [...row.cells].map((c) => cell(c.textContent)).join()).join('\n') + '\n';
}

function saveTable(id, name) {
  download(`${name}.csv`, new Blob([csvOf(element(id))], {type: 'text/csv'}));
}

async function copyCommand() {
  await navigator.clipboard.writeText(data.command);
  element('copied').textContent = 'copied';
  setTimeout(() => { element('copied').textContent = ''; }, 1500);
}

function setUpCopies() {
  element('save-picture').addEventListener('click', savePicture);
  element('save-samples').addEventListener('click', () => saveTable('pixel-table', 'samples'));
  element('save-region').addEventListener('click', () => saveTable('region-table', 'region'));
  element('copy-command').hidden = !navigator.clipboard || !data.command;
  element('copy-command').addEventListener('click', copyCommand);
}
