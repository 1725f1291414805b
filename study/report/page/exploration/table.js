'use strict';

// The chosen points as a table that a heading sorts.

const kRows = 200; // of the table at first

const tableColumns = (() => {
  const text = (name, of) => ({name, better: 0, text: of, plain: true});
  const list = columns.map((column) => column);
  if (new Set(rows.map((row) => row.limited_by)).size > 1) list.push(text('limited_by', (row) => row.limited_by));
  if (data.seeds > 1) list.unshift(text('rank', (row) => row.rank));
  if (data.rungs.length > 1) list.push({name: 'rung', better: 0, text: (row) => (row.rung ? `${row.rung}` : '–'), plain: true});
  if (rows.some((row) => row.problem)) list.push(text('problem', (row) => row.problem));
  return list;
})();

function chooseSort(name) {
  const {better} = columnOf(name) ?? {better: 0};
  const down = state.sort.name === name ? !state.sort.down : better > 0;
  choose({sort: {name, down}});
}

function heading(column) {
  if (column.plain) return made('th', {scope: 'col'}, column.name.replaceAll('_', ' '));
  const on = state.sort.name === column.name;
  const button = made('button', {type: 'button', 'data-sort': column.name}, column.title, on ? (state.sort.down ? ' ↓' : ' ↑') : '');
  button.addEventListener('click', () => chooseSort(column.name));
  return made('th', {scope: 'col', 'aria-sort': on ? (state.sort.down ? 'descending' : 'ascending') : 'none'}, button);
}

function tableRow(row) {
  const button = made('button', {type: 'button', 'aria-label': `show point ${row.number}`}, `${row.number}`);
  const marks = [row === state.point && 'chosen', isDropped(row) && 'dropped'].filter(Boolean).join(' ');
  const line = made('tr', {class: marks}, made('td', {}, button),
                    ...tableColumns.map((column) => made('td', {class: column.name}, column.text(row))));
  line.dataset.number = row.number;
  line.addEventListener('click', () => choose({point: row}));
  return line;
}

function showTable() {
  const focused = document.activeElement?.closest('#points-table button');
  const [sort, number] = [focused?.dataset.sort, focused?.closest('tr')?.dataset.number];
  const order = sortedRows();
  element('points-table').replaceChildren(
    made('thead', {}, made('tr', {}, heading({name: 'number', title: 'point'}), ...tableColumns.map(heading))),
    made('tbody', {}, ...order.slice(0, state.most).map(tableRow)));
  element('more-bar').hidden = order.length <= state.most;
  element('more').textContent = `Show more: ${order.length - state.most} left`;
  const again = sort ? `[data-sort="${sort}"]` : number ? `tr[data-number="${number}"] button` : null;
  if (again) element('points-table').querySelector(again)?.focus();
}

function markPoint() {
  for (const line of element('points-table').querySelectorAll('tbody tr'))
    line.classList.toggle('chosen', line.dataset.number === `${state.point?.number}`);
}

function setUpTable() {
  element('more').addEventListener('click', () => choose({most: state.most + kRows}));
  whenever(['ranges', 'sort', 'most'], showTable);
  whenever(['point'], markPoint);
}
