/** One line of a table, quoted where it must be (RFC 4180). */
function line(cells: string[]): string {
  return cells.map((cell) => (/[",\r\n]/.test(cell) ? `"${cell.replaceAll('"', '""')}"` : cell)).join(',');
}

export function csv(rows: string[][]): string {
  return rows.map((row) => line(row) + '\r\n').join('');
}

/** Text of a cell as a program reads it: one line, a plain minus, nothing for a dash. */
export function cellText(text: string): string {
  const words = text.replace(/\s+/g, ' ').trim().replaceAll('−', '-');
  return words === '–' ? '' : words;
}
