// The command that measures, as it can be typed into a terminal.

/** A word as a POSIX shell takes it unchanged. */
export const quoted = (word: string) =>
  /^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`;

/** What the server starts for such a job, but for how it hears of the progress. */
export function measureCommand(folder: string, experiment: string, output: string, options: Record<string, string>): string {
  const given = Object.entries(options).sort(([a], [b]) => (a < b ? -1 : 1)).map(([name, value]) => `--${name}=${value}`);
  const path = (rel: string) => `${folder.replace(/\/$/, '')}/${rel}`;
  return ['manoscope', 'measure', path(experiment), '-o', path(output), ...given].map(quoted).join(' ');
}
