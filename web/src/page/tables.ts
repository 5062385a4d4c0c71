// Every table of the page as CSV.

import { cellText, csv } from '../format/csv';
import { saveCsv } from '../format/save';

export function rowsOf(table: HTMLTableElement): string[][] {
  return [...table.rows].map((row) =>
    [...row.cells].map((cell) => cellText(cell.innerText || (cell.textContent ?? ''))),
  );
}

/** The heading that a table stands under, as the name of a file. */
function nameOf(table: HTMLTableElement, index: number): string {
  let above: Element | null = table.closest('div.scroll');
  while (above && above.tagName !== 'H2' && above.id !== 'summary') above = above.previousElementSibling;
  return `${above?.id || 'table'}_${index + 1}`;
}

export function offerTables(): void {
  document.querySelectorAll<HTMLTableElement>('div.scroll table').forEach((table, index) => {
    const name = nameOf(table, index);
    const scroll = table.closest<HTMLElement>('div.scroll')!;
    // What scrolls is reached by the keyboard, too.
    scroll.tabIndex = 0;
    scroll.setAttribute('role', 'region');
    scroll.setAttribute('aria-label', `Table ${index + 1}: ${name.replace(/_\d+$/, '')}`);
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = 'CSV';
    button.setAttribute('aria-label', `Save table ${index + 1} as CSV`);
    button.addEventListener('click', () => saveCsv(name, csv(rowsOf(table))));
    const tools = document.createElement('div');
    tools.className = 'tools table-tools';
    tools.append(button);
    scroll.after(tools);
  });
}
